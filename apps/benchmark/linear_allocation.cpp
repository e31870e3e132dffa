// The linear solution alone, on random orientations: the floor under every allocation.
#include "tenon/problems/allocation/linear_allocation.hpp"

#include <cmath>
#include <random>

#include "tenon/apps/benchmark/benchmark.hpp"
#include "tenon/problems/allocation/vehicle_file.hpp"

namespace tenon {

namespace {

constexpr int kRows = 14400;

void run(const std::string& name, BenchmarkRun& out) {
  const Vehicle vehicle = load_vehicle(name).vehicle;
  const LinearAllocation linear(vehicle);
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  std::vector<Wrench> wrenches(kRows);
  for (Wrench& w : wrenches) {
    for (double& v : w) v = normal(random);
    w.head<3>() *= vehicle.mass * vehicle.gravity / w.head<3>().norm();
  }
  Vector u(vehicle.num_rotors()), a = Vector::Zero(vehicle.num_rotors());
  double largest = 0;
  time_each(kRows, out, [&](int k) { linear.solve(wrenches[static_cast<std::size_t>(k)], a, u, a); });
  for (const Wrench& w : wrenches) {
    linear.solve(w, a, u, a);
    largest = std::max(largest, (linear.wrench(u, a) - w).lpNorm<Eigen::Infinity>());
  }
  char note[64];
  std::snprintf(note, sizeof note, "wrench error at most %.1e", largest);
  out.notes.emplace_back(note);
}

}  // namespace

void add_linear_allocation(std::vector<Benchmark>& rows) {
  for (const char* name : {"momav", "momav-bench"}) {
    rows.push_back({std::string("allocation/linear/") + name, [name](BenchmarkRun& out) { run(name, out); }});
  }
}

}  // namespace tenon
