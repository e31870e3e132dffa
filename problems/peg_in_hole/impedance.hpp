// The inner loop that moves the peg: a mass on a spring and a damper to a moving reference r.
//
//     M q'' = K (r - q) + D (r' - q') + contact forces,     D = 2 zeta sqrt(K M)
//
// Diagonal in (x, z, phi): with phi = lever * theta a stiffness is in N/mm and a mass in kg in all three.
#pragma once

#include "tenon/core/eigen.hpp"

namespace tenon::peg {

struct Impedance {
  Eigen::Vector3d mass{0.8, 0.8, 0.75};   // kg
  Eigen::Vector3d stiffness{1, 1, 7.5};  // N/mm
  double damping_ratio = 1;

  /// N s/mm: kg N/mm = 1e-3 (N s/mm)^2.
  Eigen::Vector3d damping() const { return 2 * damping_ratio * (1e-3 * stiffness.cwiseProduct(mass)).cwiseSqrt(); }
};

}  // namespace tenon::peg
