#include "tenon/problems/delta/law.hpp"

#include <algorithm>

namespace tenon::delta {

namespace {

constexpr double kLeast = 1e-3;  // nearer to a singularity than this the torques of any law are beyond any motor

bool is_clear(const Robot& robot, const Configuration& at, const Motion& motion) {
  const Singularity measure = motion.singularity(robot, at);
  return std::min({measure.type_1, measure.type_2, measure.s2}) > kLeast;
}

}  // namespace

Sensed::Sensed(const Robot& robot, const Forward& forward, const Vector3& rate)
    : y_rate(rate), wrist(forward.wrist), at(forward.at), motion(robot, forward.at) {
  ok = forward.ok() && is_clear(robot, at, motion);
  velocity.noalias() = motion.jacobian * y_rate;
}

Sensed::Sensed(const Robot& robot, const Configuration& configuration, const Vector9& v)
    : y_rate(v[0], v[3], v[6]), wrist(wrist_position(robot, configuration)), at(configuration), motion(robot, configuration) {
  ok = is_clear(robot, at, motion);
  velocity.noalias() = motion.jacobian * y_rate;
}

LawTorque Law::torque(const Sensed& sensed, const Reference& reference, const Vector3& integral) const {
  LawTorque out;
  out.gravity = gravity_torque(constants_, sensed.at, sensed.motion);
  const bool linear = options_.form == LawForm::linearising;
  out.torque = out.gravity + (linear ? linearising(sensed, reference, integral) : impedance(sensed, reference));
  return out;
}

Vector3 Law::tool_torque(const Vector3& angle, const Vector3& rate, const Vector3& reference) const {
  if (options_.form == LawForm::impedance)
    return options_.tool_stiffness.cwiseProduct(reference - angle) - options_.tool_damping.cwiseProduct(rate);
  const double p = options_.tool_pole;
  return gimbals_.linearising_torque(angle, rate, p * p * (reference - angle) - 2 * p * rate);
}

Vector3 Law::linearising(const Sensed& sensed, const Reference& reference, const Vector3& integral) const {
  const Motion& motion = sensed.motion;
  const Vector9 v = motion.rates(sensed.y_rate);
  Vector3 w = options_.gains.derivative * (reference.velocity - sensed.velocity) +
              options_.gains.proportional * (reference.position - sensed.wrist) + options_.gains.integral * integral;
  if (options_.feed_forward) w += reference.acceleration;

  Vector9 force = Vector9::Zero();
  if (options_.coriolis) {
    const MotionBias bias = motion_bias(robot_, sensed.at, motion, v);
    w -= bias.wrist;
    for (int i = 0; i < kArms; ++i) {
      force.segment<3>(3 * i) = coriolis(constants_, sensed.at[i], v.segment<3>(3 * i)) +
                                ArmInertia(constants_, sensed.at[i]) * Vector3(bias.gamma.segment<3>(3 * i));
    }
  }
  if (options_.damping) {
    for (int i = 0; i < kArms; ++i) force.segment<3>(3 * i) += constants_.damping.cwiseProduct(v.segment<3>(3 * i));
  }
  return reduced_inertia(constants_, sensed.at, motion, options_.inertia) * motion.motors(w) + to_motors(motion, force);
}

Vector3 Law::impedance(const Sensed& sensed, const Reference& reference) const {
  const Vector3 force = options_.stiffness.cwiseProduct(reference.position - sensed.wrist) +
                        options_.impedance_damping.cwiseProduct(reference.velocity - sensed.velocity);
  return sensed.motion.jacobian.transpose() * force;
}

}  // namespace tenon::delta
