// An integrator of one Dae, for those who hold it without knowing which it is.
//
// It advances a state in time across events. At the start and after every event it makes the state consistent (xdot and y from F = 0),
// tests the levels (Dae::transition until nothing changes) and goes on; guards are located to `event_tolerance`.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <string_view>

#include "tenon/core/dae.hpp"

namespace tenon {

struct IntegratorOptions {
  double rtol = 1e-8;                                         // of each step, relative to a state's size
  double atol = 1e-10;                                        // and absolute, in the state's own unit
  double event_tolerance = 1e-12;                             // s: width of the interval in which a guard's zero is known to lie
  double max_step = std::numeric_limits<double>::infinity();  // s
  double output_step = 0;                                     // s: on_output at its multiples, counted from the first start; 0 for none
  long max_steps = 100'000'000;
  int max_events_at_once = 1000;  // transitions without time going on, before the run is given up

  /// A consistent state: at the start, at every output step (after what a clock does there), and on either side of an event that resets x
  /// or changes the discrete mode. Return false to stop there.
  std::function<bool(const DaeState&)> on_output = nullptr;
  Dae::EventLog on_event = nullptr;
};

/// Throws std::invalid_argument, naming the option, where one makes no sense.
void validate(const IntegratorOptions& options);

enum class IntegrationStatus {
  reached,              // the end
  stopped,              // on_output said so
  no_consistent_state,  // F = 0 could not be solved for xdot and y: no consistent multipliers, or not of index 1
  transition_failed,    // the Dae cannot go on; it says why
  too_many_events,      // time does not go on any more
  step_collapse,        // no step is small enough
  step_limit,
};

std::string_view to_string(IntegrationStatus status);

struct IntegrationResult {
  IntegrationStatus status = IntegrationStatus::reached;
  std::string explanation;  // one line where the status is not reached or stopped
  long steps = 0, rejected = 0, evaluations = 0, events = 0;
};

class Integrator {
 public:
  virtual ~Integrator() = default;

  /// Takes the state to t_end, across all events on the way; whatever the status, it is then the last accepted one. A state that was
  /// changed from outside since the last call (another u, a reset x) is made consistent first. Does not throw for the outcome of a run.
  virtual IntegrationResult advance(DaeState& state, double t_end) = 0;
};

}  // namespace tenon
