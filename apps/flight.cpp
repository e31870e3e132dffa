#include "tenon/apps/flight.hpp"

#include <chrono>
#include <cmath>

#include "tenon/apps/make_allocator.hpp"
#include "tenon/solvers/make_integrator.hpp"

namespace tenon {

flight::MakeAllocator allocator_maker(const std::string& solver, const Options& options) {
  return [solver, options](const Vehicle& vehicle) { return make_allocator(vehicle, solver, options); };
}

FlightResult fly(const flight::FlightDae& dae, const FlightObservers& observers, const std::string& integrator_name) {
  const auto start = std::chrono::steady_clock::now();
  const flight::Mission& mission = dae.mission();
  FlightResult out;
  IntegratorOptions options;
  options.rtol = mission.rtol;
  options.atol = 1e-2 * mission.rtol;
  options.on_event = [&](const DaeEvent& event) {
    out.statistics.add(event);
    if (observers.on_event) observers.on_event(event);
  };
  const auto integrator = make_integrator(integrator_name, dae, options);
  out.state = initial_state_of(dae);
  flight::FlightTick tick;
  const long ticks = std::lround(mission.duration / mission.controller.period);
  for (long k = 0; k <= ticks; ++k) {
    const IntegrationResult result = integrator->advance(out.state, static_cast<double>(k) * mission.controller.period);
    out.status = result.status;
    out.explanation = result.explanation;
    if (result.status != IntegrationStatus::reached) break;
    dae.last_tick(out.state, tick);
    out.statistics.add(tick);
    if (observers.on_tick && !observers.on_tick(out.state, tick)) {
      out.status = IntegrationStatus::stopped;
      break;
    }
  }
  out.elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return out;
}

}  // namespace tenon
