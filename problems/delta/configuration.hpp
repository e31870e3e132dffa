// A configuration of the delta robot: the sines and cosines of its nine angles, worked out once and shared by all that follows.
//
//     arm frame:  e = (0, cos q1, sin q1)               along the proximal link
//                 d = (s2 s3, c2, s2 c3)                along the distal link;   d2 = dd/dq2,   d3 = (dd/dq3)/s2,   d, d2, d3 orthonormal
//     world:      z = R_i psi_i,   psi = (0, c, 0) + l1 e + l2 d                                               (delta.md, 1.1 to 1.3)
#pragma once

#include <array>
#include <numbers>

#include "tenon/problems/allocation/lane_trigonometry.hpp"
#include "tenon/problems/delta/robot.hpp"

namespace tenon::delta {

inline constexpr int kArms = 3;

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Vector9 = Eigen::Matrix<double, 9, 1>;  // q11, q12, q13, q21, ..., q33 (rad), or their rates

/// v of arm i's frame in world axes: R_i v.
inline Vector3 to_world(int arm, const Vector3& v) {
  constexpr double c = -0.5, s = std::numbers::sqrt3 / 2;
  switch (arm) {
    case 0:
      return v;
    case 1:
      return {c * v[0] - s * v[1], s * v[0] + c * v[1], v[2]};
    default:
      return {c * v[0] + s * v[1], -s * v[0] + c * v[1], v[2]};
  }
}

/// v of world axes in arm i's frame: R_i' v.
inline Vector3 to_arm(int arm, const Vector3& v) {
  return to_world((kArms - arm) % kArms, v);
}

struct ArmConfiguration {
  double c1, s1, c2, s2, c3, s3;  // cosines and sines of q1, q2, q3

  Vector3 e() const { return {0, c1, s1}; }
  Vector3 e1() const { return {0, -s1, c1}; }  // de/dq1
  Vector3 d() const { return {s2 * s3, c2, s2 * c3}; }
  Vector3 d2() const { return {c2 * s3, -s2, c2 * c3}; }  // dd/dq2
  Vector3 d3() const { return {c3, 0, -s3}; }             // (dd/dq3) / s2

  /// psi: the wrist in the arm's frame.
  Vector3 wrist(const Robot& robot) const {
    return Vector3(0, robot.radial_offset(), 0) + robot.proximal_length * e() + robot.distal_length * d();
  }
  /// P = dpsi/dq.
  Matrix3 jacobian(const Robot& robot) const {
    Matrix3 p;
    p.col(0) = robot.proximal_length * e1();
    p.col(1) = robot.distal_length * d2();
    p.col(2) = robot.distal_length * s2 * d3();
    return p;
  }
  /// Pdot v: what is left of the wrist's acceleration where the angles' is zero.
  Vector3 bias(const Robot& robot, const Vector3& v) const {
    // d'' = -q2'^2 d + 2 c2 q2' q3' d3 - s2 q3'^2 (s2 d + c2 d2),   e'' = -q1'^2 e                                             (2.4)
    const Vector3 d_bias = -(v[1] * v[1] + s2 * s2 * v[2] * v[2]) * d() - s2 * c2 * v[2] * v[2] * d2() + 2 * c2 * v[1] * v[2] * d3();
    return -robot.proximal_length * v[0] * v[0] * e() + robot.distal_length * d_bias;
  }
};

struct Configuration {
  std::array<ArmConfiguration, kArms> arm;

  Configuration() = default;
  explicit Configuration(const Vector9& q) {
    Eigen::Array<double, 9, 1> sine, cosine;
    sine_and_cosine<double, 9>(q.array(), sine, cosine);
    for (int i = 0; i < kArms; ++i) {
      const int k = 3 * i;
      arm[std::size_t(i)] = {cosine[k], sine[k], cosine[k + 1], sine[k + 1], cosine[k + 2], sine[k + 2]};
    }
  }
  const ArmConfiguration& operator[](int i) const { return arm[std::size_t(i)]; }
};

}  // namespace tenon::delta
