// The Radau IIA method with s points: order 2 s - 1, L-stable, its last point the end of the step.
//
//     F(xdot_i, X_i, Y_i) = 0,    xdot_i = (1/h) sum_{j=0..s} D_ij X_j,    X_0 = x(t),    X_s = x(t + h)          collocation.md (1)
//
// [E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, 2nd ed., Springer (1996), sec. IV.5]
#pragma once

#include "tenon/core/eigen.hpp"

namespace tenon {

struct Radau {
  int points = 0;     // s
  Vector abscissae;   // s + 1: 0, c_1, .., c_s = 1
  Eigen::MatrixXd d;  // s x (s + 1): derivative at c_i of the polynomial through the values at the abscissae
  Vector weights;     // s: b_i, of the quadrature of order 2 s - 1
};

/// Throws std::invalid_argument where there is no point, or more than 8.
Radau radau(int points);

}  // namespace tenon
