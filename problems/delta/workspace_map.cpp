#include "tenon/problems/delta/workspace_map.hpp"

#include <Eigen/SVD>
#include <cmath>

#include "tenon/problems/delta/dynamics.hpp"

namespace tenon::delta {

double reach(const Robot& robot) {
  return std::abs(robot.radial_offset()) + robot.proximal_length + robot.distal_length;
}

double axial_reach(const Robot& robot) {
  const double links = robot.proximal_length + robot.distal_length, c = robot.radial_offset();
  return std::sqrt(links * links - c * c);
}

WorkspacePoint workspace_point(const Robot& robot, const Configuration& at) {
  const Motion motion(robot, at);
  WorkspacePoint point;
  point.wrist = wrist_position(robot, at);
  point.singularity = motion.singularity(robot, at);
  if (point.singularity.type_2 > kSingular) {
    const Vector3 speeds = motion.jacobian.jacobiSvd().singularValues();
    point.speed_least = speeds[2];
    point.speed_greatest = speeds[0];
    point.gravity_torque = gravity_torque(ArmConstants(robot), at, motion).lpNorm<Eigen::Infinity>();
  }
  return point;
}

double map_workspace(const Robot& robot, int divisions, const std::function<void(const WorkspacePoint&)>& visit) {
  const double step = reach(robot) / divisions;
  for (int z = 0; z <= divisions; ++z) {
    for (int y = -divisions; y <= divisions; ++y) {
      for (int x = -divisions; x <= divisions; ++x) {
        const Vector3 wrist = step * Vector3(x, y, z);
        const Inverse inverse = inverse_kinematics(robot, wrist);
        if (!inverse.ok()) continue;
        const Configuration at(inverse.q);
        WorkspacePoint point = workspace_point(robot, at);
        point.wrist = wrist;
        if (point.singularity.s2 > kSingular) visit(point);
      }
    }
  }
  return step;
}

}  // namespace tenon::delta
