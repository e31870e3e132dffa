// A mission flown from its start to its end, tick by tick.
#pragma once

#include <functional>
#include <string>

#include "tenon/core/integrator.hpp"
#include "tenon/core/options.hpp"
#include "tenon/problems/flight/flight_statistics.hpp"

namespace tenon {

/// Allocators for missions: make_allocator() with these arguments.
flight::MakeAllocator allocator_maker(const std::string& solver = "newton-kkt", const Options& options = {});

struct FlightResult {
  IntegrationStatus status = IntegrationStatus::reached;
  std::string explanation;  // where it is not reached or stopped
  DaeState state;           // the last
  flight::FlightStatistics statistics;
  double elapsed = 0;       // s
};

struct FlightObservers {
  /// After every tick; false where the flight is to stop.
  std::function<bool(const DaeState&, const flight::FlightTick&)> on_tick = nullptr;
  Dae::EventLog on_event = nullptr;
};

FlightResult fly(const flight::FlightDae& dae, const FlightObservers& observers = {}, const std::string& integrator = "dop853");

}  // namespace tenon
