#include "tenon/core/integrator.hpp"

#include <stdexcept>

namespace tenon {

namespace {

void expect(bool makes_sense, const char* name, double value, const char* expected) {
  if (makes_sense) return;
  throw std::invalid_argument("option " + std::string(name) + " is " + std::to_string(value) + " (expected " + expected + ")");
}

}  // namespace

void validate(const IntegratorOptions& options) {
  expect(options.rtol > 0 && options.rtol < 1, "rtol", options.rtol, "a number in (0, 1)");
  expect(options.atol > 0, "atol", options.atol, "a number above 0");
  expect(options.event_tolerance > 0, "event_tolerance", options.event_tolerance, "a number above 0");
  expect(options.max_step > 0, "max_step", options.max_step, "a number above 0");
  expect(options.output_step >= 0, "output_step", options.output_step, "0 or more");
  expect(options.max_steps > 0, "max_steps", static_cast<double>(options.max_steps), "1 or more");
  expect(options.max_events_at_once > 0, "max_events_at_once", options.max_events_at_once, "1 or more");
}

std::string_view to_string(IntegrationStatus status) {
  switch (status) {
    case IntegrationStatus::reached:
      return "reached";
    case IntegrationStatus::stopped:
      return "stopped";
    case IntegrationStatus::no_consistent_state:
      return "no_consistent_state";
    case IntegrationStatus::transition_failed:
      return "transition_failed";
    case IntegrationStatus::too_many_events:
      return "too_many_events";
    case IntegrationStatus::step_collapse:
      return "step_collapse";
    case IntegrationStatus::step_limit:
      return "step_limit";
  }
  return "unknown";
}

}  // namespace tenon
