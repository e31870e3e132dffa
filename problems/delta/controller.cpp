#include "tenon/problems/delta/controller.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

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
  require(options.tactile_limit >= 0, "tactile_limit", options.tactile_limit, "0 or more");
  require(std::abs(options.tactile_axis.norm() - 1) < 1e-9, "the length of tactile_axis", options.tactile_axis.norm(), "1");
  require(std::isfinite(options.tactile_gain), "tactile_gain", options.tactile_gain, "a finite number");
}

Controller::Controller(const Robot& robot, const ControllerOptions& options)
    : law_(robot, validated(options).law), options_(options), filter_(options.filter_frequency, options.period) {}

void ControllerState::write(Eigen::Ref<Vector> numbers) const {
  numbers.segment<3>(0) = integral;
  numbers.segment<3>(3) = previous_angle;
  numbers.segment<3>(6) = holding;
  numbers.segment<3>(9) = filter.s1;
  numbers.segment<3>(12) = filter.s2;
  numbers[15] = shift;
  numbers[16] = has_previous;
}

ControllerState ControllerState::read(const Eigen::Ref<const Vector>& numbers) {
  ControllerState state;
  state.integral = numbers.segment<3>(0);
  state.previous_angle = numbers.segment<3>(3);
  state.holding = numbers.segment<3>(6);
  state.filter = {numbers.segment<3>(9), numbers.segment<3>(12)};
  state.shift = numbers[15];
  state.has_previous = numbers[16] != 0;
  return state;
}

Reference Controller::reference() const {
  Reference moved = reference_;
  moved.position += state_.shift * options_.tactile_axis;
  return moved;
}

const Command& Controller::tick(const Measurement& measurement) {
  const Sensed sensed(law_.robot(), measurement.angle, rate(measurement));
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

Vector3 Controller::rate(const Measurement& measurement) {
  if (options_.filter_frequency == 0) return measurement.rate;
  const Vector3 difference = state_.has_previous ? Vector3((measurement.angle - state_.previous_angle) / options_.period) : Vector3::Zero();
  state_.previous_angle = measurement.angle;
  state_.has_previous = true;
  return filter_(difference, state_.filter);
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
