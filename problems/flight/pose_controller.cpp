#include "tenon/problems/flight/pose_controller.hpp"

#include <stdexcept>
#include <string>

namespace tenon::flight {

namespace {

void require(bool holds, const std::string& name, double value, const std::string& expected) {
  if (!holds) throw std::invalid_argument(name + " is " + std::to_string(value) + " (expected " + expected + ")");
}

void validate(const Gains& gains, const std::string& name) {
  require(gains.proportional >= 0, "the proportional gain of " + name, gains.proportional, "0 or more");
  require(gains.integral >= 0, "the integral gain of " + name, gains.integral, "0 or more");
  require(gains.derivative >= 0, "the derivative gain of " + name, gains.derivative, "0 or more");
  require(gains.integral_limit >= 0, "the integral limit of " + name, gains.integral_limit, "0 or more");
}

const PoseControllerOptions& validated(const PoseControllerOptions& options) {
  validate(options);
  return options;
}

}  // namespace

void validate(const PoseControllerOptions& options) {
  require(options.body.mass > 0, "mass", options.body.mass, "more than 0 kg");
  require(options.body.inertia.minCoeff() > 0, "the least inertia", options.body.inertia.minCoeff(), "more than 0 kg m^2");
  require(options.period > 0, "period", options.period, "more than 0 s");
  require(options.observer_bandwidth > 0, "observer_bandwidth", options.observer_bandwidth, "more than 0 rad/s");
  require(options.disturbance_share >= 0 && options.disturbance_share <= 1, "disturbance_share", options.disturbance_share, "0 to 1");
  require(options.actuator_lag >= 0, "actuator_lag", options.actuator_lag, "0 s or more");
  require(options.lead >= 0, "lead", options.lead, "0 s or more");
  validate(options.force, "the force");
  validate(options.torque, "the torque");
}

bool is_stable(const Gains& gains, double mass, double lag) {
  // (3.6) m T s^4 + m s^3 + D s^2 + P s + I has its roots on the left iff all coefficients are positive and, after Routh,
  // (D - T P) P > m I
  const double P = gains.proportional, I = gains.integral, D = gains.derivative;
  return P > 0 && D > lag * P && (D - lag * P) * P > mass * I;
}

void PoseControllerState::write(Eigen::Ref<Vector> numbers) const {
  numbers.segment<3>(0) = estimate.position;
  numbers.segment<3>(3) = estimate.velocity;
  numbers.segment<3>(6) = estimate.unexplained;
  numbers.segment<4>(9) = estimate.attitude.coeffs();
  numbers.segment<3>(13) = estimate.rate;
  numbers.segment<3>(16) = estimate.unexplained_angular;
  numbers.segment<3>(19) = force_integral;
  numbers.segment<3>(22) = torque_integral;
  numbers.segment<6>(25) = acting;
  numbers.segment<6>(31) = asked;
  numbers[37] = is_short;
  numbers[38] = has_estimate;
}

PoseControllerState PoseControllerState::read(const Eigen::Ref<const Vector>& numbers) {
  PoseControllerState state;
  state.estimate.position = numbers.segment<3>(0);
  state.estimate.velocity = numbers.segment<3>(3);
  state.estimate.unexplained = numbers.segment<3>(6);
  state.estimate.attitude.coeffs() = numbers.segment<4>(9);
  state.estimate.rate = numbers.segment<3>(13);
  state.estimate.unexplained_angular = numbers.segment<3>(16);
  state.force_integral = numbers.segment<3>(19);
  state.torque_integral = numbers.segment<3>(22);
  state.acting = numbers.segment<6>(25);
  state.asked = numbers.segment<6>(31);
  state.is_short = numbers[37] != 0;
  state.has_estimate = numbers[38] != 0;
  return state;
}

PoseController::PoseController(const PoseControllerOptions& options)
    : options_(validated(options)),
      observer_(options.body, options.observer_bandwidth, options.period),
      acting_share_(options.actuator_lag > 0 ? -std::expm1(-options.period / options.actuator_lag) : 1) {}

const Wrench& PoseController::tick(const PoseMeasurement* measurement, const PoseReference& reference) {
  estimate(measurement);
  const RigidBody& body = options_.body;
  const BodyEstimate& now = state_.estimate;

  // (4.5) where it will be when the command acts, moving on as the reference does
  const double lead = options_.lead;
  const Vector3d turn = now.attitude.conjugate() * reference.angular_acceleration;  // body axes
  const Vector3d velocity = now.velocity + lead * reference.acceleration;
  const Vector3d position = now.position + lead * (now.velocity + lead / 2 * reference.acceleration);
  const Vector3d rate = now.rate + lead * turn;
  const Quaterniond attitude = now.attitude * rotation_of(lead * (now.rate + lead / 2 * turn));
  const Quaterniond to_body = attitude.conjugate();

  // (3.1), (3.2); the rotation vector of q_E is the same in the reference's axes and in the body's: it lies along the axis of the turn
  const Vector3d e = position - reference.position;
  const Vector3d r = rotation_vector(reference.attitude.conjugate() * attitude);
  integrate(e, options_.force, state_.force_integral);
  integrate(attitude * r, options_.torque, state_.torque_integral);

  // (3.3)
  const double share = options_.disturbance_share;
  const Vector3d force = -options_.force.proportional * e - state_.force_integral -
                         options_.force.derivative * (velocity - reference.velocity) +
                         body.mass * (reference.acceleration + body.gravity * Vector3d::UnitZ() - share * now.unexplained);
  // (3.4)
  const Vector3d torque = -options_.torque.proportional * r - to_body * state_.torque_integral -
                          options_.torque.derivative * (rate - to_body * reference.angular_velocity) +
                          body.inertia.cwiseProduct(to_body * reference.angular_acceleration - share * now.unexplained_angular) +
                          rate.cross(body.inertia.cwiseProduct(rate));
  state_.asked << to_body * force, torque;
  state_.is_short = false;
  return state_.asked;
}

void PoseController::estimate(const PoseMeasurement* measurement) {
  if (!state_.has_estimate) {
    BodyEstimate& first = state_.estimate;
    first.position = measurement->position;
    first.velocity = measurement->velocity;
    first.attitude = measurement->attitude;
    first.rate = measurement->angular_velocity;
    state_.acting << first.attitude.conjugate() * Vector3d(0, 0, options_.body.mass * options_.body.gravity), Vector3d::Zero();
    state_.has_estimate = true;
    return;
  }
  // (4.1) the wrench that acts, in the middle of the period
  const Wrench change = acting_share_ * (state_.asked - state_.acting);
  observer_.predict(state_.acting + change / 2, state_.estimate);
  state_.acting += change;
  if (measurement) observer_.correct(*measurement, state_.estimate);
}

void PoseController::integrate(const Vector3d& error, const Gains& gains, Vector3d& integral) const {
  for (int k = 0; k < 3; ++k) {
    const double change = options_.period * gains.integral * error[k];
    if (state_.is_short && change * integral[k] > 0) continue;
    integral[k] = std::min(std::max(integral[k] + change, -gains.integral_limit), gains.integral_limit);
  }
}

}  // namespace tenon::flight
