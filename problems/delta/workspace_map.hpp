// What a delta robot reaches, and how near its singularities that is: one row for each point of a cubic grid below its base.
#pragma once

#include <functional>

#include "tenon/problems/delta/kinematics.hpp"

namespace tenon::delta {

struct WorkspacePoint {
  Vector3 wrist;  // z, m
  Singularity singularity;
  double speed_least = 0;  // least and greatest singular value of J_c: wrist speed per motor speed, m
  double speed_greatest = 0;
  double gravity_torque = 0;  // the largest of the three, N m; 0 at type II, where there is none
};

/// The farthest the wrist comes from the middle of the base, m.
double reach(const Robot& robot);

/// The greatest z on the axis, m.
double axial_reach(const Robot& robot);

/// Calls `visit` for every reached point of the grid of step reach/`divisions` with z >= 0, in the order z, y, x. Returns the step, m.
double map_workspace(const Robot& robot, int divisions, const std::function<void(const WorkspacePoint&)>& visit);

/// The same quantities at one pose.
WorkspacePoint workspace_point(const Robot& robot, const Configuration& at);

}  // namespace tenon::delta
