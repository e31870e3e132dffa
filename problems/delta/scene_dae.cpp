#include "tenon/problems/delta/scene_dae.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace tenon::delta {

namespace {

Robot with_payload(Robot robot, double payload) {
  robot.payload = payload;
  return robot;
}

}  // namespace

SceneDae::SceneDae(Scene scene)
    : scene_(std::move(scene)),
      constants_(scene_.robot),
      controller_options_(scene_.controller),
      believed_(with_payload(scene_.robot, scene_.controller_payload)),
      law_(believed_, scene_.controller.law),
      gimbals_{scene_.robot.gimbal_inertia} {
  const Inverse inverse = inverse_kinematics(scene_.robot, scene_.position);
  if (!inverse.ok()) {
    throw std::invalid_argument("the wrist starts out of reach of arm " + std::to_string(inverse.unreachable_arm + 1) + ", " +
                                std::to_string(distance_to_workspace(scene_.robot, scene_.position)) + " m from the workspace");
  }
  q_ = inverse.q;
  const Configuration at(q_);
  const Motion motion(scene_.robot, at);
  const bool moves = !scene_.velocity.isZero();
  if (motion.singularity(scene_.robot, at).s2 < kSingular || (moves && !Sensed(scene_.robot, at, Vector9::Zero()).ok)) {
    throw std::invalid_argument("the wrist starts at a singularity, where its velocity does not determine the arms'");
  }
  v_.setZero();
  if (moves) v_ = motion.rates(motion.motors(scene_.velocity));
  const auto add_states = [this](bool present, int count) {
    const int first = present ? num_states_ : -1;
    if (present) num_states_ += count;
    return first;
  };
  integral_ = add_states(is_continuous(), 3);
  object_ = add_states(scene_.object.mass > 0, 2);
  tool_ = add_states(scene_.has_tool, 6);
}

void SceneDae::initial_state(DaeState& state) const {
  state.x.head<9>() = q_;
  state.x.segment<9>(9) = v_;
  if (object_ >= 0) state.x[object_] = scene_.object.position;
  if (tool_ >= 0) state.x.segment<3>(tool_) = scene_.tool_angle;
  state.mode.discrete.assign(static_cast<std::size_t>(num_contacts()), 0);
  if (is_sampled()) state.mode.held = Vector::Zero(num_held());
  state.x[work_] = energy(state);
}

SceneDae::Touch SceneDae::touch(int i, const DaeMode& mode, double t, ConstVectorRef x, const Vector3& wrist,
                                const Vector3& velocity) const {
  const Contact& c = contact(i);
  Touch out{};
  out.gap = c.normal.dot(wrist) + c.offset;
  out.rate = c.normal.dot(velocity);
  if (c.is_finger) {
    const Gripper& g = scene_.gripper;
    out.gap += g.opening(t);
    if (t > g.begin && t < g.end) out.opening_rate = (g.to - g.from) / (g.end - g.begin);
    out.rate += out.opening_rate;
    if (object_ >= 0) {
      const double along = c.normal.dot(controller_options_.tactile_axis);
      out.gap -= along * x[object_];
      out.rate -= along * x[object_ + 1];
    }
  }
  const bool touches = mode.discrete[static_cast<std::size_t>(i)] != 0;
  out.force = touches ? -c.stiffness * out.gap - c.damping * out.rate : 0;
  return out;
}

Vector3 SceneDae::torque(const DaeMode& mode, double t, ConstVectorRef x, const Configuration& at) const {
  if (is_sampled()) return mode.held.head<3>();
  if (!is_continuous()) return Vector3::Zero();
  const Sensed sensed(believed_, at, x.segment<9>(9));
  if (!sensed.ok) return Vector3::Constant(std::numeric_limits<double>::quiet_NaN());
  const double most = scene_.robot.torque_limit;
  return law_.torque(sensed, scene_.reference.at(t), x.segment<3>(integral_)).torque.cwiseMax(-most).cwiseMin(most);
}

Vector3 SceneDae::integral_rate(double t, ConstVectorRef x, const Vector3& wrist) const {
  Vector3 rate = scene_.reference.at(t).position - wrist;
  const double most = controller_options_.integral_limit / law_.options().gains.integral;
  for (int k = 0; k < 3; ++k) {
    if (std::abs(x[integral_ + k]) >= most && x[integral_ + k] * rate[k] > 0) rate[k] = 0;
  }
  return rate;
}

Vector3 SceneDae::tool_torque(const DaeMode& mode, ConstVectorRef x) const {
  if (is_sampled()) return mode.held.segment<3>(3);
  const double most = scene_.robot.gimbal_torque_limit;
  return law_.tool_torque(x.segment<3>(tool_), x.segment<3>(tool_ + 3), scene_.tool_reference).cwiseMax(-most).cwiseMin(most);
}

Vector3 SceneDae::tool_acceleration(const DaeMode& mode, ConstVectorRef x) const {
  return gimbals_.acceleration(x.segment<3>(tool_), x.segment<3>(tool_ + 3), tool_torque(mode, x));
}

/// Of all that changes the energy: motors, friction, pushes, the contacts' dampers, the gripper.
double SceneDae::power(const DaeMode& mode, const DaePoint& at, const Vector3& wrist, const Vector3& velocity) const {
  double sum = 0;
  for (int i = 0; i < kArms; ++i) {
    const Vector3 v = at.x.segment<3>(9 + 3 * i);
    sum += at.y[kTorque + i] * v[0] - constants_.damping.dot(v.cwiseProduct(v));
  }
  const Vector3 push = scene_.push.at(at.t);
  sum += scene_.push.on_object ? push[0] * at.x[object_ + 1] : push.dot(velocity);
  for (int i = 0; i < num_contacts(); ++i) {
    if (mode.discrete[static_cast<std::size_t>(i)] == 0) continue;
    const Touch now = touch(i, mode, at.t, at.x, wrist, velocity);
    sum -= contact(i).damping * now.rate * now.rate + at.y[kContact + i] * now.opening_rate;
  }
  if (object_ >= 0) sum -= scene_.object.damping * at.x[object_ + 1] * at.x[object_ + 1];
  if (tool_ >= 0) sum += tool_torque(mode, at.x).dot(at.x.segment<3>(tool_ + 3));
  return sum;
}

/// All but the contacts'.
double SceneDae::object_force(double t, ConstVectorRef x) const {
  const Object& object = scene_.object;
  const double push = scene_.push.on_object ? scene_.push.at(t)[0] : 0;
  return push - object.stiffness * (x[object_] - object.position) - object.damping * x[object_ + 1];
}

std::array<Vector3, kArms> SceneDae::tip_forces(const DaePoint& at) const {
  Vector3 force = scene_.push.on_object ? Vector3(Vector3::Zero()) : scene_.push.at(at.t);
  for (int i = 0; i < num_contacts(); ++i) force += at.y[kContact + i] * contact(i).normal;
  const Vector3 third = force / 3, l1 = at.y.head<3>(), l2 = at.y.segment<3>(3);
  return {third + l1 + l2, to_arm(1, third - l1), to_arm(2, third - l2)};
}

void SceneDae::residual(const DaeMode& mode, const DaePoint& at, Workspace&, VectorRef F) const {
  const Robot& robot = scene_.robot;
  const Configuration configuration(Vector9(at.x.head<9>()));
  const std::array<Vector3, kArms> force = tip_forces(at);
  Vector3 wrist = Vector3::Zero(), velocity = Vector3::Zero();
  std::array<Vector3, kArms> tip;

  F.head<9>() = at.xdot.head<9>() - at.x.segment<9>(9);
  for (int i = 0; i < kArms; ++i) {
    const Vector3 v = at.x.segment<3>(9 + 3 * i);
    const ArmResidual arm = arm_residual(robot, constants_, configuration[i], v, at.xdot.segment<3>(9 + 3 * i), force[std::size_t(i)]);
    F.segment<3>(9 + 3 * i) = arm.balance;
    F[9 + 3 * i] -= at.y[kTorque + i];
    tip[std::size_t(i)] = to_world(i, arm.tip);
    wrist += to_world(i, configuration[i].wrist(robot)) / 3;
    velocity += to_world(i, configuration[i].jacobian(robot) * v) / 3;
  }
  F.segment<3>(num_states_) = tip[0] - tip[1];
  F.segment<3>(num_states_ + 3) = tip[0] - tip[2];
  F.segment<3>(num_states_ + kTorque) = at.y.segment<3>(kTorque) - at.u - torque(mode, at.t, at.x, configuration);

  double on_object = 0;
  for (int i = 0; i < num_contacts(); ++i) {
    const double y = at.y[kContact + i];
    if (contact(i).is_finger) on_object -= y * contact(i).normal.dot(controller_options_.tactile_axis);
    F[num_states_ + kContact + i] = y - touch(i, mode, at.t, at.x, wrist, velocity).force;
  }
  F[work_] = at.xdot[work_] - power(mode, at, wrist, velocity);
  if (integral_ >= 0) F.segment<3>(integral_) = at.xdot.segment<3>(integral_) - integral_rate(at.t, at.x, wrist);
  if (object_ >= 0) {
    F[object_] = at.xdot[object_] - at.x[object_ + 1];
    F[object_ + 1] = scene_.object.mass * at.xdot[object_ + 1] - object_force(at.t, at.x) - on_object;
  }
  if (tool_ >= 0) {
    F.segment<3>(tool_) = at.xdot.segment<3>(tool_) - at.x.segment<3>(tool_ + 3);
    F.segment<3>(tool_ + 3) = at.xdot.segment<3>(tool_ + 3) - tool_acceleration(mode, at.x);
  }
}

void SceneDae::derivatives(const DaeMode& mode, double t, ConstVectorRef x, ConstVectorRef u, Workspace&, VectorRef xdot,
                           VectorRef y) const {
  const Robot& robot = scene_.robot;
  const Vector9 q = x.head<9>(), v = x.segment<9>(9);
  const Configuration configuration(q);
  Vector3 force = scene_.push.on_object ? Vector3(Vector3::Zero()) : scene_.push.at(t);
  double on_object = 0;
  Vector3 wrist = Vector3::Zero(), velocity = Vector3::Zero();
  if (num_contacts() > 0 || integral_ >= 0 || !force.isZero()) {
    wrist = wrist_position(robot, configuration);
    velocity = simulation_jacobian(robot, configuration) * v;
  }
  for (int i = 0; i < num_contacts(); ++i) {
    const double y_i = y[kContact + i] = touch(i, mode, t, x, wrist, velocity).force;
    force += y_i * contact(i).normal;
    if (contact(i).is_finger) on_object -= y_i * contact(i).normal.dot(controller_options_.tactile_axis);
  }
  const Vector3 motors = u + torque(mode, t, x, configuration);
  const Acceleration acceleration = delta::acceleration(robot, constants_, configuration, v, motors, force);
  xdot.head<9>() = v;
  xdot.segment<9>(9) = acceleration.v_rate;
  y.head<6>() = acceleration.lambda;
  y.segment<3>(kTorque) = motors;
  xdot[work_] = power(mode, DaePoint(t, xdot, x, y, u), wrist, velocity);
  if (integral_ >= 0) xdot.segment<3>(integral_) = integral_rate(t, x, wrist);
  if (object_ >= 0) {
    xdot[object_] = x[object_ + 1];
    xdot[object_ + 1] = (object_force(t, x) + on_object) / scene_.object.mass;
  }
  if (tool_ >= 0) {
    xdot.segment<3>(tool_) = x.segment<3>(tool_ + 3);
    xdot.segment<3>(tool_ + 3) = tool_acceleration(mode, x);
  }
}

}  // namespace tenon::delta
