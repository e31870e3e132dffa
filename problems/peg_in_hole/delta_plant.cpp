#include "tenon/problems/peg_in_hole/delta_plant.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <stdexcept>

#include "tenon/problems/delta/encoder.hpp"
#include "tenon/problems/peg_in_hole/channels.hpp"
#include "tenon/problems/peg_in_hole/impedance.hpp"

namespace tenon::peg {

namespace {

using delta::ToolMotion;
using delta::Vector3;
using delta::Wrench;

constexpr double kMouth = 0.4;  // m below the base: the task's origin
constexpr int kEncoderBits = 20;
constexpr double kFilterFrequency = 200;  // Hz, of the inner loop's rates

constexpr std::array<const char*, 19> kOutputNames{"q11",   "q12",  "q13",        "q21",          "q22",        "q23",     "q31",
                                                   "q32",   "q33",  "closure",    "torque1",      "torque2",    "torque3", "yaw",
                                                   "pitch", "roll", "torque_yaw", "torque_pitch", "torque_roll"};

/// Of the plane (x, z up; mm) in the robot's axes (z down; m), and back.
Vector3 to_robot(double x, double z) {
  return {1e-3 * x, 0, kMouth - 1e-3 * z};
}
Vector3d to_plane(const Vector3& position, double theta, double lever) {
  return {1e3 * position[0], 1e3 * (kMouth - position[2]), lever * theta};
}

Vector3d pose_in_plane(const ToolMotion& tool, double lever) {
  return to_plane(tool.position, std::asin(-tool.attitude(2, 0)), lever);
}
Vector3d rate_in_plane(const ToolMotion& tool, double lever) {
  return {1e3 * tool.velocity[0], -1e3 * tool.velocity[2], lever * tool.angular_velocity[1]};
}

delta::ControllerOptions inner_loop(double period) {
  return {.law = {.form = delta::LawForm::impedance}, .period = period, .filter_frequency = kFilterFrequency};
}

}  // namespace

DeltaPegPlant::DeltaPegPlant(const World& world, const delta::Robot& robot, const delta::Robot& believed)
    : InsertionPlant(world),
      robot_(robot, {.period = kStep, .micro_step = kStep}),
      controller_(believed, inner_loop(kPeriod)),
      observer_(believed, {.period = kPeriod, .gain = 1 / world.force_filter}) {
  if (!(robot.gimbal_inertia.minCoeff() > 0))
    throw std::invalid_argument("robot " + robot.name + " has no gimbals (expected a spherical wrist)");
  const Vector3 start = to_robot(world.start[0], world.start[1]);
  if (!robot_.place(start, {0, world.start[2] / world.geometry.lever, 0}))
    throw std::invalid_argument(fmt::format("robot {} does not reach the peg's start at ({}, 0, {}) m", robot.name, start[0], start[2]));
  DeltaPegPlant::reset(0);
}

void DeltaPegPlant::reset(std::uint64_t seed) {
  InsertionPlant::reset(seed);
  lost_ = false;
  const double lever = world_.geometry.lever;
  robot_.place(to_robot(pose_[0], pose_[1]), {0, pose_[2] / lever, 0});
  controller_.reset();
  observer_.reset();
  const delta::Configuration at(robot_.angles());
  acting_ = coming_ = {.arms = gravity_torque(delta::ArmConstants(robot_.robot()), at, delta::Motion(robot_.robot(), at))};
  seen_.reset(pose_);
}

void DeltaPegPlant::read_encoders() {
  const Vector3 motors = robot_.motors(), gimbals = robot_.gimbals();
  for (int i = 0; i < 3; ++i) {
    reading_.angle[i] = delta::quantised(motors[i], kEncoderBits);
    reading_.gimbal_angle[i] = delta::quantised(gimbals[i], kEncoderBits);
  }
}

Vector3d DeltaPegPlant::damping_of_loop() const {
  return Impedance{world_.mass, stiffness_}.damping();
}

// What is out of the plane is held as stiffly as what is in it.
void DeltaPegPlant::schedule() {
  const double turn = 1e-3 * world_.geometry.lever * world_.geometry.lever;  // N/mm of phi to N m/rad
  const Vector3d damping = damping_of_loop();
  delta::LawOptions law = controller_.law().options();
  law.stiffness = 1e3 * stiffness_({0, 0, 1});
  law.impedance_damping = 1e3 * damping({0, 0, 1});
  law.tool_stiffness.setConstant(turn * stiffness_[2]);
  law.tool_damping.setConstant(turn * damping[2]);
  controller_.set_law(law);
}

void DeltaPegPlant::sample() {
  const double lever = world_.geometry.lever;
  read_encoders();
  observer_.update(reading_.angle, reading_.gimbal_angle, acting_.arms, acting_.gimbals);
  const delta::Forward forward = forward_kinematics(controller_.law().robot(), reading_.angle);
  seen_.update(to_plane(forward.wrist, reading_.gimbal_angle[1], lever), kPeriod);

  schedule();
  // no farther away than the spring may push
  const Eigen::Vector2d seen = seen_.reading().head<2>(), most = world_.largest_spring * stiffness_.head<2>().cwiseInverse();
  const Eigen::Vector2d wanted = reference_.head<2>().cwiseMax(seen - most).cwiseMin(seen + most);
  controller_.set_reference(
      {.position = to_robot(wanted[0], wanted[1]), .velocity = {1e-3 * reference_rate_[0], 0, -1e-3 * reference_rate_[1]}});
  // K (r - q) + D (r' - q') of a law that has no r': K (r + D/K r' - q) - D q'
  const double lead = stiffness_[2] > 0 ? damping_of_loop()[2] / stiffness_[2] : 0;
  controller_.set_tool_reference({0, (reference_[2] + lead * reference_rate_[2]) / lever, 0});
  acting_ = coming_;
  const delta::Command& command = controller_.tick(reading_);
  coming_ = {command.torque, command.gimbal_torque};
}

void DeltaPegPlant::step() {
  if (is_sample()) sample();
  const double lever = world_.geometry.lever;
  const auto force = [&](const ToolMotion& tool) {
    const Vector3d on_pose = contacts(pose_in_plane(tool, lever), rate_in_plane(tool, lever)).force;
    return Wrench{{on_pose[0], 0, -on_pose[1]}, {0, 1e-3 * lever * on_pose[2], 0}};
  };
  lost_ = !robot_.step(acting_.arms, acting_.gimbals, force);
  const ToolMotion tool = robot_.tool();
  pose_ = pose_in_plane(tool, lever);
  rate_ = rate_in_plane(tool, lever);
  contacts_ = contacts(pose_, rate_);
}

void DeltaPegPlant::measure(VectorRef values) {
  measure_motion(seen_.reading(), seen_.rate(), values);
  const Wrench& wrench = observer_.wrench();
  values.segment<3>(kMeasuredForce) << wrench.force[0], -wrench.force[2], wrench.moment[1];
}

int DeltaPegPlant::num_outputs() const {
  return InsertionPlant::num_outputs() + static_cast<int>(kOutputNames.size());
}

std::string DeltaPegPlant::output_name(int i) const {
  const int own = i - InsertionPlant::num_outputs();
  return own < 0 ? InsertionPlant::output_name(i) : kOutputNames[static_cast<std::size_t>(own)];
}

void DeltaPegPlant::outputs(VectorRef values) const {
  const int shared = InsertionPlant::num_outputs();
  InsertionPlant::outputs(values.head(shared));
  values.tail(num_outputs() - shared) << robot_.angles(), robot_.closure().lpNorm<Eigen::Infinity>(), robot_.torque(), robot_.gimbals(),
      robot_.gimbal_torque();
}

}  // namespace tenon::peg
