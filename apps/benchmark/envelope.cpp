// The envelope of a vehicle in 10,000 directions, hover efficiency and all three boundaries: one run is the whole grid.
#include "tenon/problems/envelope/envelope.hpp"

#include <fmt/format.h>

#include "tenon/apps/benchmark/benchmark.hpp"
#include "tenon/problems/allocation/vehicle_file.hpp"
#include "tenon/problems/envelope/sphere.hpp"

namespace tenon {

namespace {

constexpr int kRuns = 5, kDirections = 10'000;

void run(BenchmarkRun& out) {
  Envelope envelope(load_vehicle("momav").vehicle);
  const std::vector<Eigen::Vector3d> grid = sphere_grid(kDirections);
  double gap = 0;
  time_each(kRuns, out, [&](int) {
    for (const Eigen::Vector3d& direction : grid) gap = std::max(gap, envelope.at(direction).force_gap);
  });
  out.notes.push_back(fmt::format("forces proved to {:.1e} N", gap));
}

}  // namespace

void add_envelope(std::vector<Benchmark>& rows) {
  rows.push_back({"envelope/10000", &run});
}

}  // namespace tenon
