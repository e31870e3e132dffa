// Where the wrist is, how it moves with the motors, and where that ends.
//
//     psi_1 = R_i psi_i  (i = 2, 3)                closure h = 0: 6 equations for 9 angles
//     A z' = diag(b) y',   J_c = A^-1 diag(b)      A: rows (R_i d_i)',  b_i = l1 d_i . e1_i,  y = (q11, q21, q31): what the motors turn
//     v = Gamma y',   H Gamma = 0                                                                     (delta.md, sections 1 to 4)
//
// Nothing here allocates or throws.
#pragma once

#include <array>

#include "tenon/problems/delta/configuration.hpp"

namespace tenon::delta {

// --- position -------------------------------------------------------------------------------------------------------------------------

struct Inverse {
  Vector9 q;
  int unreachable_arm = -1;  // from 0; -1: the pose is reached
  bool ok() const { return unreachable_arm < 0; }
};

/// The angles that bring the wrist to z (m), elbows out; where an arm does not reach, the first such is named and q is not set.
Inverse inverse_kinematics(const Robot& robot, const Vector3& z);

/// The same without evaluating an angle; returns the first arm, from 0, that does not reach z, or -1.
int place_wrist(const Robot& robot, const Vector3& z, Configuration& at);

enum class ForwardStatus {
  solved,
  unreachable,      // no wrist position joins the three elbows
  singular,         // type II: the wrist lies in the plane of the elbows, or the elbows on a line
  iteration_limit,  // Newton's method only
};

struct Forward {
  ForwardStatus status = ForwardStatus::singular;
  Vector3 wrist{0, 0, 0};  // z, m
  Configuration at;        // of all nine angles
  bool ok() const { return status == ForwardStatus::solved; }
};

/// From the motor angles y (rad) by intersection of three spheres of radius l2 about the elbows; of its two points the one with larger z.
Forward forward_kinematics(const Robot& robot, const Vector3& y);

/// The same by Newton's method on h = 0, from the other six angles of `guess`, whichever side of type II it lies on; q comes back in
/// `guess`.
Forward forward_newton(const Robot& robot, const Vector3& y, Vector9& guess);

/// The nine angles of a configuration: q1 and q3 in (-pi, pi], q2 in [0, pi].
Vector9 angles(const Configuration& at);

/// From z to the nearest point that all arms reach, m; 0 where they reach z.
double distance_to_workspace(const Robot& robot, const Vector3& z);

// --- closure --------------------------------------------------------------------------------------------------------------------------

using Matrix69 = Eigen::Matrix<double, 6, 9>;
using Matrix39 = Eigen::Matrix<double, 3, 9>;
using Matrix93 = Eigen::Matrix<double, 9, 3>;

Vector6 closure(const Robot& robot, const Configuration& at);                         // h, m
Matrix69 closure_jacobian(const Robot& robot, const Configuration& at);               // H = dh/dq
Vector6 closure_bias(const Robot& robot, const Configuration& at, const Vector9& v);  // Hdot v
Matrix39 simulation_jacobian(const Robot& robot, const Configuration& at);            // J_v = (1/3) [P1, R2 P2, R3 P3]
Vector3 wrist_position(const Robot& robot, const Configuration& at);                  // mean of R_i psi_i, m

// --- motion ---------------------------------------------------------------------------------------------------------------------------

/// How near a configuration is to where things break; all without unit, 0 at the singularity.
struct Singularity {
  double type_1 = 0;  // the least |b_i| / l1: an arm is stretched or folded, the motor cannot move the wrist along its distal link
  double type_2 = 0;  // |det A|: the wrist is in the plane of the elbows, the motors cannot hold it
  double s2 = 0;      // the least sin q_i2: a singularity of the angles alone
};

inline constexpr double kSingular = 1e-9;  // below this a measure counts as 0

/// The motors' motion and the wrist's, for one configuration.
struct Motion {
  Matrix3 a;          // A, rows (R_i d_i)'
  Matrix3 a_inverse;  // of no meaning where det_a is 0
  double det_a = 0;
  Vector3 b{0, 0, 0};                // m
  Matrix3 jacobian;                  // J_c = A^-1 diag(b), m
  std::array<Matrix3, kArms> gamma;  // rows 3i .. 3i+2 of Gamma

  Motion(const Robot& robot, const Configuration& at);

  Singularity singularity(const Robot& robot, const Configuration& at) const;
  Matrix93 gamma_matrix() const;
  /// v = Gamma y'.
  Vector9 rates(const Vector3& y_rate) const;
  /// J_c^-1 r, r a rate or an acceleration; infinite at type I.
  Vector3 motors(const Vector3& wrist) const { return (a * wrist).cwiseQuotient(b); }
};

/// What is left of the accelerations where the motors' is zero.
struct MotionBias {
  Vector3 wrist;  // J_c' y', m/s^2
  Vector9 gamma;  // gbar = Gamma' y', rad/s^2; zero in the motors' rows
};
MotionBias motion_bias(const Robot& robot, const Configuration& at, const Motion& motion, const Vector9& v);

}  // namespace tenon::delta
