#include "tenon/problems/delta/plant.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

namespace tenon::delta {

namespace {

const Robot& validated(const Robot& robot) {
  const RobotFault fault = find_fault(robot);
  if (!fault.key.empty()) throw std::invalid_argument(fault.found + " (expected " + fault.expected + ")");
  return robot;
}

const PlantOptions& validated(const PlantOptions& options) {
  const auto require = [](bool holds, const char* name, double value) {
    if (!holds) throw std::invalid_argument(std::string(name) + " is " + std::to_string(value) + " s (expected more than 0)");
  };
  require(options.period > 0, "period", options.period);
  require(options.micro_step > 0, "micro_step", options.micro_step);
  if (!options.tool.allFinite()) throw std::invalid_argument("tool is not finite (expected metres in the tool's frame)");
  return options;
}

Vector3 cut(const Vector3& torque, double most) {
  return torque.cwiseMax(-most).cwiseMin(most);
}

}  // namespace

Plant::Plant(const Robot& robot, const PlantOptions& options)
    : robot_(validated(robot)),
      constants_(robot),
      gimbals_{robot.gimbal_inertia},
      options_(validated(options)),
      micro_steps_(static_cast<int>(std::ceil(options.period / options.micro_step * (1 - 1e-12)))),
      micro_step_(options.period / micro_steps_),
      has_gimbals_(gimbals_.are_there()) {}

bool Plant::place(const Vector3& wrist, const Vector3& gimbals, const Vector3& velocity, const Vector3& gimbal_rates) {
  State start;
  start.position << wrist, gimbals;
  start.velocity << velocity, gimbal_rates;
  if (!has_gimbals_) start.velocity.tail<3>().setZero();
  if (!acceleration(start, pose(start), {}).allFinite()) return false;
  state_ = start;
  torque_.setZero(), gimbal_torque_.setZero();
  return true;
}

void Plant::hold(const Vector3& torque, const Vector3& gimbal_torque) {
  torque_ = cut(torque, robot_.torque_limit);
  gimbal_torque_ = cut(gimbal_torque, robot_.gimbal_torque_limit);
}

Plant::Pose Plant::pose(const State& at) const {
  const GimbalFrame frame(at.position.tail<3>());
  Pose out;
  out.axes = frame.axes;
  out.tool.attitude = frame.attitude;
  out.tool.angular_velocity = frame.axes * at.velocity.tail<3>();
  const Vector3 arm = frame.attitude * options_.tool;
  out.tool.position = at.position.head<3>() + arm;
  out.tool.velocity = at.velocity.head<3>() + out.tool.angular_velocity.cross(arm);
  return out;
}

Vector6 Plant::acceleration(const State& at, const Pose& pose, const Wrench& wrench) const {
  Vector6 out = Vector6::Zero();
  Configuration configuration;
  if (place_wrist(robot_, at.position.head<3>(), configuration) >= 0) {
    out.setConstant(std::numeric_limits<double>::quiet_NaN());
    return out;
  }
  out.head<3>() = wrist_acceleration(robot_, constants_, configuration, at.velocity.head<3>(), torque_, wrench.force);
  if (has_gimbals_) {
    const Vector3 arm = pose.tool.position - at.position.head<3>();
    const Vector3 moment = wrench.moment + arm.cross(wrench.force);  // about the gimbals' centre
    out.tail<3>() = gimbals_.acceleration(at.position.tail<3>(), at.velocity.tail<3>(), gimbal_torque_ + pose.axes.transpose() * moment);
  }
  return out;
}

Vector9 Plant::angles() const {
  return inverse_kinematics(robot_, wrist()).q;
}

Vector9 Plant::rates() const {
  Configuration at;
  place_wrist(robot_, wrist(), at);
  return rates_of_wrist(robot_, at, velocity());
}

Vector3 Plant::motors() const {
  return angles()({0, 3, 6});
}

Vector3 Plant::motor_rates() const {
  return rates()({0, 3, 6});
}

Vector6 Plant::closure() const {
  return delta::closure(robot_, Configuration(angles()));
}

double Plant::energy() const {
  Configuration at;
  place_wrist(robot_, wrist(), at);
  return kinetic_energy(constants_, at, rates_of_wrist(robot_, at, velocity())) + potential_energy(constants_, at) +
         gimbals_.kinetic_energy(gimbals(), gimbal_rates());
}

}  // namespace tenon::delta
