// Flying: one whole control tick (pose controller and allocation) along a noisy orientation sweep, and a minute of tumbling simulated.
#include <fmt/format.h>

#include <cmath>

#include "tenon/apps/benchmark/benchmark.hpp"
#include "tenon/apps/flight.hpp"
#include "tenon/problems/flight/mission_file.hpp"
#include "tenon/problems/flight/noise.hpp"

namespace tenon {

namespace {

using namespace flight;

constexpr int kFlights = 5;

struct Seen {
  PoseMeasurement measurement;
  PoseReference reference;
};

/// Poses along a flight, as its sensors see them.
std::vector<Seen> poses(const Mission& mission) {
  std::vector<Seen> out;
  const FlightDae dae(mission, allocator_maker());
  fly(dae, {.on_tick = [&](const DaeState& state, const FlightTick& tick) {
        Noise noise(mission.seed, out.size());
        Seen seen;
        seen.reference = tick.reference;
        seen.measurement.position = state.x.head<3>() + mission.sensors.position_noise * noise.normal3();
        seen.measurement.attitude = Quaterniond(state.x[3], state.x[4], state.x[5], state.x[6]) *
                                    rotation_of(mission.sensors.attitude_noise * noise.normal3());
        out.push_back(seen);
        return true;
      }});
  return out;
}

void run_tick(BenchmarkRun& out) {
  const Mission mission = load_mission("orientation-sweep");
  const std::vector<Seen> seen = poses(mission);
  PoseController controller(mission.controller);
  const auto allocator = allocator_maker()(mission.vehicle);
  double sum = 0;
  time_each(static_cast<int>(seen.size()), out, [&](int k) {
    const Seen& now = seen[static_cast<std::size_t>(k)];
    const Wrench& wrench = controller.tick(&now.measurement, now.reference);
    const Allocation& allocation = allocator->allocate(wrench, mission.controller.period);
    controller.given(wrench + allocation.error, allocation.status != AllocationStatus::solved);
    sum += allocation.throttle[0];
  });
  if (!std::isfinite(sum)) out.notes.emplace_back("not finite");
}

void run_minute(BenchmarkRun& out) {
  const Mission mission = load_mission("tumble", {"simulation.duration=60"});
  const FlightDae dae(mission, allocator_maker());
  double error = 0;
  time_each(kFlights, out, [&](int) { error = fly(dae).statistics.position_error.mean(); });
  out.notes.push_back(fmt::format("tumble, mean position error {:.2g} mm", 1e3 * error));
}

}  // namespace

void add_flight(std::vector<Benchmark>& rows) {
  rows.push_back({"flight/tick", &run_tick});
  rows.push_back({"flight/60s", &run_minute});
}

}  // namespace tenon
