// Rotations as unit quaternions and as rotation vectors (axis times angle, rad).
//
//     exp(r) = ( cos(|r|/2), sin(|r|/2)/|r| r )            log(q) = alpha/|vec q| vec q,   alpha = 2 atan2(|vec q|, w) in [0, pi]
#pragma once

#include "tenon/core/eigen.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace tenon::flight {

using Eigen::Quaterniond;
using Eigen::Vector3d;

inline Quaterniond rotation_of(const Vector3d& vector) {
  const double angle = vector.norm();
  const double share = angle > 1e-8 ? std::sin(angle / 2) / angle : 0.5;
  Quaterniond q;
  q.w() = std::cos(angle / 2);
  q.vec() = share * vector;
  return q;
}

/// The shorter way round: of q and -q that with w >= 0.
inline Vector3d rotation_vector(const Quaterniond& q) {
  const double sign = q.w() < 0 ? -1 : 1, length = q.vec().norm();
  // (1.3) the factor is 2 as |vec| -> 0
  const double factor = length > 1e-8 ? 2 * std::atan2(length, sign * q.w()) / length : 2;
  return sign * factor * q.vec();
}

}  // namespace tenon::flight
