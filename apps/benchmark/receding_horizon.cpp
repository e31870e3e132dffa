// soft_walls/step, touch_down/step, peg_in_hole/step: whole ticks of a receding horizon (estimate, shift, solve, accept) in closed loop; Ipopt as a peer.
#include <fmt/format.h>

#include <algorithm>

#include "tenon/apps/benchmark/benchmark.hpp"
#include "tenon/apps/statistics.hpp"
#include "tenon/mpc/closed_loop.hpp"
#include "tenon/mpc/task_controllers.hpp"
#include "tenon/problems/tasks.hpp"
#include "tenon/solvers/make_solver.hpp"

namespace tenon {

namespace {

constexpr int kWorlds = 20, kPeerWorlds = 1;

void run_task(const std::string& name, const std::string& solver, int worlds, BenchmarkRun& out) {
  ControlTask task = make_task(name);
  const auto controller =
      take_controller(task, "mpc", [&](const Nlp& problem, const Options& options) { return make_solver(solver, problem, options); });
  ClosedLoop loop(*task.plant, *controller, task.duration);
  std::vector<double> iterating;  // the times of ticks that took an iteration at least
  long iterations = 0, fallbacks = 0;
  for (int world = 0; world < worlds; ++world) {
    loop.run(static_cast<std::uint64_t>(world), [&](const Vector&) {
      const StepLog step = controller->last_step();
      out.seconds.push_back(step.elapsed);
      if (step.iterations > 0) iterating.push_back(step.elapsed);
      iterations += step.iterations;
      fallbacks += step.fell_back() ? 1 : 0;
      return true;
    });
  }
  out.notes.push_back(fmt::format("{:.2f} iterations a tick; {} of {} ticks iterate, their median {:.1f} us, p99 {:.1f} us; {} fallbacks",
                                  static_cast<double>(iterations) / static_cast<double>(out.seconds.size()), iterating.size(),
                                  out.seconds.size(), 1e6 * median(iterating), 1e6 * percentile(iterating, 0.99), fallbacks));
}

void add(const std::string& row, const std::string& task, std::vector<Benchmark>& rows) {
  rows.push_back({row, [=](BenchmarkRun& out) { run_task(task, "newton-kkt", kWorlds, out); }});
  const std::vector<SolverDescription> solvers = list_solvers();
  if (std::ranges::any_of(solvers, [](const auto& s) { return s.name == "ipopt" && s.available; })) {
    rows.push_back({row + "/ipopt", [=](BenchmarkRun& out) { run_task(task, "ipopt", kPeerWorlds, out); }});
  }
}

}  // namespace

void add_receding_horizon(std::vector<Benchmark>& rows) {
  add("soft_walls/step", "cart-pole-soft-walls", rows);
  add("touch_down/step", "delta-touch-down", rows);
  add("peg_in_hole/step", "peg-in-hole", rows);
}

}  // namespace tenon
