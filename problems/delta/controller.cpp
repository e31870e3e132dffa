#include "tenon/problems/delta/controller.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <type_traits>

namespace tenon::delta {

namespace {

void require(bool holds, const std::string& name, double value, const std::string& expected) {
  if (!holds) throw std::invalid_argument(name + " is " + std::to_string(value) + " (expected " + expected + ")");
}

const ControllerOptions& validated(const ControllerOptions& options) {
  validate(options);
  return options;
}

}  // namespace

void validate(const ControllerOptions& options) {
  require(options.period > 0, "period", options.period, "more than 0 s");
  require(options.integral_limit >= 0, "integral_limit", options.integral_limit, "0 or more");
  require(options.filter_frequency >= 0 && options.filter_frequency * options.period < 0.5, "filter_frequency", options.filter_frequency,
          "0, or less than half of 1/period");
  require(options.law.tool_pole > 0, "tool_pole", options.law.tool_pole, "more than 0");
  require(options.tactile_limit >= 0, "tactile_limit", options.tactile_limit, "0 or more");
  require(std::abs(options.tactile_axis.norm() - 1) < 1e-9, "the length of tactile_axis", options.tactile_axis.norm(), "1");
  require(std::isfinite(options.tactile_gain), "tactile_gain", options.tactile_gain, "a finite number");
}

Controller::Controller(const Robot& robot, const ControllerOptions& options)
    : law_(robot, validated(options).law), options_(options), filter_(options.filter_frequency, options.period) {}

namespace {

/// Calls `field` with every number of a state (a Vector3 or a double) and its place in the vector of them all.
template <class State, class Field>
void for_each_field(State& state, const Field& field) {
  field(0, state.integral), field(3, state.holding);
  int k = 6;
  for (auto* angles : {&state.arms, &state.gimbals}) {
    field(k, angles->previous), field(k + 3, angles->filter.s1), field(k + 6, angles->filter.s2), field(k + 9, angles->has_previous);
    k += 10;
  }
  field(k, state.shift);
}

}  // namespace

void ControllerState::write(Eigen::Ref<Vector> numbers) const {
  for_each_field(*this, [&](int k, const auto& value) {
    if constexpr (requires { value.size(); })
      numbers.segment<3>(k) = value;
    else
      numbers[k] = value;
  });
}

ControllerState ControllerState::read(const Eigen::Ref<const Vector>& numbers) {
  ControllerState state;
  for_each_field(state, [&](int k, auto& value) {
    if constexpr (requires { value.size(); })
      value = numbers.segment<3>(k);
    else
      value = static_cast<std::remove_reference_t<decltype(value)>>(numbers[k]);
  });
  return state;
}

Reference Controller::reference() const {
  Reference moved = reference_;
  moved.position += state_.shift * options_.tactile_axis;
  return moved;
}

const Command& Controller::tick(const Measurement& measurement) {
  if (law_.has_gimbals()) turn_tool(measurement);
  const Sensed sensed(law_.robot(), measurement.angle, rate(measurement.angle, measurement.rate, state_.arms));
  command_.singular = !sensed.ok;
  if (!sensed.ok) {
    limit(state_.holding);
    return command_;
  }
  const double shift_rate = move_reference(measurement);
  Reference wanted = reference();
  wanted.velocity += shift_rate * options_.tactile_axis;
  command_.wrist = sensed.wrist;
  command_.error = wanted.position - sensed.wrist;
  const LawTorque torque = law_.torque(sensed, wanted, state_.integral);
  state_.holding = torque.gravity;
  limit(torque.torque);
  integrate();
  return command_;
}

Vector3 Controller::rate(const Vector3& angle, const Vector3& measured, DifferenceState& state) const {
  if (options_.filter_frequency == 0) return measured;
  const Vector3 difference = state.has_previous ? Vector3((angle - state.previous) / options_.period) : Vector3::Zero();
  state.previous = angle;
  state.has_previous = true;
  return filter_(difference, state.filter);
}

void Controller::turn_tool(const Measurement& measurement) {
  const double most = law_.robot().gimbal_torque_limit;
  const Vector3 angle_rate = rate(measurement.gimbal_angle, measurement.gimbal_rate, state_.gimbals);
  command_.gimbal_torque = law_.tool_torque(measurement.gimbal_angle, angle_rate, tool_reference_).cwiseMax(-most).cwiseMin(most);
}

void Controller::limit(const Vector3& torque) {
  const double most = law_.robot().torque_limit;
  command_.torque = torque.cwiseMax(-most).cwiseMin(most);
  command_.saturated = (torque.array().abs() > most).any();
}

double Controller::move_reference(const Measurement& measurement) {
  const double rate = options_.tactile_gain * (measurement.tactile_left - measurement.tactile_right);
  const double before = state_.shift;
  state_.shift = std::clamp(before + options_.period * rate, -options_.tactile_limit, options_.tactile_limit);
  return (state_.shift - before) / options_.period;
}

void Controller::integrate() {
  const double ki = law_.options().gains.integral;
  if (ki > 0 && !command_.saturated) {
    const double most = options_.integral_limit / ki;
    state_.integral = (state_.integral + options_.period * command_.error).cwiseMax(-most).cwiseMin(most);
  }
}

}  // namespace tenon::delta
