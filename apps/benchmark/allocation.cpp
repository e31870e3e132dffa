// Whole ticks of the allocation on momav: a hover sweep, the same with noise, a random walk; soft limits as in the notes, and hard ones. The
// published algorithm and Ipopt run on the same sweep. A step is the time of a tick divided by its Newton steps.
//
// Every sequence runs five times from its start; a row's time is the median of its five.
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "tenon/apps/benchmark/benchmark.hpp"
#include "tenon/apps/benchmark/textbook_allocation.hpp"
#include "tenon/apps/make_allocator.hpp"
#include "tenon/apps/statistics.hpp"
#include "tenon/problems/allocation/vehicle_file.hpp"
#include "tenon/problems/allocation/wrench_sequences.hpp"

namespace tenon {

namespace {

constexpr const char* kVehicle = "momav";
constexpr int kPasses = 5;
constexpr int kRows = 14400, kPeerRows = 300;
constexpr double kForceNoise = 0.5, kTorqueNoise = 0.05;  // N, N m
constexpr std::uint64_t kSeed = 1;

Vehicle vehicle_with(bool hard_limits) {
  Vehicle vehicle = load_vehicle(kVehicle).vehicle;
  vehicle.hard_limits = hard_limits;
  return vehicle;
}

std::vector<Wrench> sequence(const std::string& name, const Vehicle& vehicle) {
  if (name == "random_walk") return random_walk(vehicle, kRows, kSeed);
  std::vector<Wrench> sweep = hover_sweep(vehicle, kRows);
  return name == "hover_sweep_noise" ? with_noise(std::move(sweep), kForceNoise, kTorqueNoise, kSeed) : sweep;
}

/// Fills `out` with one time for each row, or for each Newton step of a row that takes any.
void run(Allocator& allocator, const std::vector<Wrench>& wrenches, int passes, bool per_step, BenchmarkRun& out) {
  std::vector<std::vector<double>> seconds(wrenches.size());
  std::vector<double> iterations;
  int best_effort = 0, fallback = 0;
  double residual = 0;
  for (int pass = 0; pass < passes; ++pass) {
    allocator.reset();
    for (std::size_t k = 0; k < wrenches.size(); ++k) {
      const Allocation& allocation = allocator.allocate(wrenches[k], kSequenceStep);
      seconds[k].push_back(allocation.elapsed);
      if (pass > 0) continue;
      iterations.push_back(allocation.iterations);
      best_effort += allocation.status == AllocationStatus::best_effort;
      fallback += allocation.status == AllocationStatus::fallback;
      if (allocation.status != AllocationStatus::fallback) residual = std::max(residual, allocation.residual);
    }
  }
  for (std::size_t k = 0; k < wrenches.size(); ++k) {
    if (!per_step) out.seconds.push_back(median(seconds[k]));
    else if (iterations[k] > 0) out.seconds.push_back(median(seconds[k]) / iterations[k]);
  }
  out.notes.push_back(fmt::format("iterations {:.0f}, p99 {:.0f}, at most {:.0f}", median(iterations), percentile(iterations, 0.99),
                                  percentile(iterations, 1)));
  out.notes.push_back(fmt::format("residual at most {:.0e}", residual));
  if (best_effort > 0) out.notes.push_back(fmt::format("{} best effort", best_effort));
  if (fallback > 0) out.notes.push_back(fmt::format("{} fallback", fallback));
}

void run_ours(const std::string& name, bool hard_limits, bool per_step, BenchmarkRun& out) {
  const Vehicle vehicle = vehicle_with(hard_limits);
  run(*make_allocator(vehicle, "newton-kkt", {}), sequence(name, vehicle), kPasses, per_step, out);
}

void run_textbook(const std::string& name, bool per_step, BenchmarkRun& out) {
  const Vehicle vehicle = vehicle_with(false);
  TextbookAllocator allocator(vehicle);
  run(allocator, sequence(name, vehicle), kPasses, per_step, out);
}

/// Rows from the middle of the sequence: the beginning is slow.
void run_peer(const std::string& name, bool hard_limits, const std::string& solver, BenchmarkRun& out) {
  const Vehicle vehicle = vehicle_with(hard_limits);
  const std::vector<Wrench> all = sequence(name, vehicle);
  const auto from = all.begin() + kRows / 3;
  run(*make_allocator(vehicle, solver, {}), {from, from + kPeerRows}, 1, false, out);
}

}  // namespace

void add_allocation(std::vector<Benchmark>& rows) {
  const auto add = [&](std::string name, std::function<void(BenchmarkRun&)> run) {
    rows.push_back({"allocation/" + std::move(name), std::move(run)});
  };
  const std::vector<std::string> peers = list_allocators();
  const bool has_ipopt = std::ranges::find(peers, "ipopt") != peers.end();
  for (const bool hard : {false, true}) {
    const std::string suffix = hard ? "_hard" : "";
    for (const std::string name : {"hover_sweep", "hover_sweep_noise", "random_walk"}) {
      add(name + suffix, [=](BenchmarkRun& out) { run_ours(name, hard, false, out); });
    }
    if (has_ipopt) add("hover_sweep" + suffix + "/ipopt", [=](BenchmarkRun& out) { run_peer("hover_sweep", hard, "ipopt", out); });
  }
  add("textbook", [](BenchmarkRun& out) { run_textbook("hover_sweep", false, out); });
  add("textbook_noise", [](BenchmarkRun& out) { run_textbook("hover_sweep_noise", false, out); });
  add("step", [](BenchmarkRun& out) { run_ours("hover_sweep_noise", false, true, out); });
  add("textbook_step", [](BenchmarkRun& out) { run_textbook("hover_sweep_noise", true, out); });
}

}  // namespace tenon
