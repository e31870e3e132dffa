// The robot's motion in the wrist's own coordinates: three arms that share a tip, each of which the wrist's position determines.
//
//     q_i' = P_i^-1 R_i' z',     q_i'' = P_i^-1 (R_i' z'' - Pdot_i q_i')
//     [ sum T_i' m_i T_i ] z'' = f + sum T_i' ( B u_i - c_i - damping q_i' - g_i + m_i P_i^-1 Pdot_i q_i' ),   T_i = P_i^-1 R_i'
//                                                                                                          (delta.md, section 12)
// No closure is left to drift and no angle to evaluate. Regular wherever all arms reach, type II in it; not finite at type I, which is
// the workspace's border, and where sin q_i2 = 0. Nothing here allocates or throws.
#pragma once

#include "tenon/problems/delta/dynamics.hpp"

namespace tenon::delta {

/// v of all nine angles (rad/s) where the wrist moves at `velocity` (m/s).
Vector9 rates_of_wrist(const Robot& robot, const Configuration& at, const Vector3& velocity);

/// Of [ inertia ] z'' = force: what the bracket and the right side above are.
struct WristBalance {
  Matrix3 inertia = Matrix3::Zero();  // kg
  Vector3 force{0, 0, 0};             // N
};
WristBalance wrist_balance(const Robot& robot, const ArmConstants& k, const Configuration& at, const Vector3& velocity, const Vector3& u,
                           const Vector3& f);

/// z'' (m/s^2) under the motors' torques u (N m) and the force f on the wrist (N, world axes).
Vector3 wrist_acceleration(const Robot& robot, const ArmConstants& k, const Configuration& at, const Vector3& velocity, const Vector3& u,
                           const Vector3& f);

}  // namespace tenon::delta
