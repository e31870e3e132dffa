#include "tenon/problems/delta/robot.hpp"

#include <fmt/format.h>

#include <cmath>

#include "tenon/problems/delta/robot_keys.hpp"

namespace tenon::delta {

RobotFault find_fault(const Robot& robot) {
  for (const RobotKey& key : kRobotKeys) {
    const double value = robot.*key.field;
    const bool positive = key.allowed == Allowed::positive;
    if (std::isnan(value) || value < 0 || (positive && value == 0)) {
      return {key.name, fmt::format("{} is {} {}", key.name, value, key.unit), positive ? "more than 0" : "0 or more"};
    }
  }
  for (const RobotVectorKey& key : kRobotVectorKeys) {
    const Eigen::Vector3d& v = robot.*key.field;
    if (!((v.array() >= 0).all() && v.allFinite())) {
      return {key.name, fmt::format("{} is [{}, {}, {}] {}", key.name, v[0], v[1], v[2], key.unit), "three numbers, 0 or more"};
    }
  }
  if (robot.distal_inertia == 0 && robot.tip_mass() == 0) {
    return {"distal_inertia", "distal_inertia and wrist_mass are both 0", "a distal link that has inertia"};
  }
  const double least = std::abs(robot.radial_offset()) - robot.proximal_length;  // from an elbow to the axis
  if (robot.distal_length <= least) {
    return {"distal_length", fmt::format("distal_length is {} m, too short for the arms to meet", robot.distal_length),
            fmt::format("more than {}", least)};
  }
  return {};
}

}  // namespace tenon::delta
