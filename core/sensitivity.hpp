// How the solution moves with the problem's parameters p: x'(p), lambda'(p), z'(p), from the first-order conditions at the solution.
//
// Along a solution path the active bounds B and rows A stay (strict complementarity), so differentiating  grad f + J' lambda + z = 0,
// c_A - D (lambda - preload) = its bound,  x_B = its bound  by p gives, with F the variables off their bounds,
//
//     [ H_FF   J_AF' ] [ x_F'     ]       [ d/dp (grad f + J' lambda)_F + H_FB x_B' ]
//     [ J_AF  -D_A   ] [ lambda_A' ]  = - [ d/dp (c - bound)_A          + J_AB x_B' ]                                              (1)
//
// and z_B' = -(d/dp (grad f + J' lambda) + H x' + J' lambda')_B.   [A. V. Fiacco, Introduction to Sensitivity and Stability Analysis in
// Nonlinear Programming, Academic Press (1983), ch. 3]
#pragma once

#include "tenon/core/point.hpp"

namespace tenon {

/// What moves with q parameters at one (x, lambda), everything else held.
struct ParameterDerivatives {
  Eigen::MatrixXd gradient;  // n x q: of grad f + J' lambda
  Eigen::MatrixXd rows;      // m x q: of c(x) minus the bound it may reach (both sides of a row move alike)
  Eigen::MatrixXd bounds;    // n x q: of the bounds of x (both sides alike): a measured state that fixes variables
};

/// A problem that declares parameters. Their values are the problem's own affair, moved by its setters.
class ParametricNlp : public Nlp {
 public:
  virtual int num_parameters() const = 0;  // q

  virtual std::string parameter_name(int k) const { return "p[" + std::to_string(k) + "]"; }

  /// Fills derivatives that arrive with the right sizes and all 0.
  virtual void parameter_derivatives(ConstVectorRef x, ConstVectorRef lambda, Workspace& workspace, ParameterDerivatives& out) const = 0;
};

struct Sensitivity {
  Eigen::MatrixXd x, lambda, z;    // n x q, m x q, n x q: derivatives by the parameters
  bool is_unique = false;          // false: (1) is singular, the solution or its multipliers are not unique there, and the matrices are 0
  double complementarity_gap = 0;  // the least of max(|multiplier|, distance) over all bounds: near 0 the active set may change, and the
                                   // derivatives hold on one side only
};

/// At `point`, a solution of the problem. A bound is active where its multiplier is larger than the distance to it. Allocates; costs one
/// sparse LU factorisation. Throws std::invalid_argument where the point has the wrong sizes, a row is soft or the Hessian is not exact.
Sensitivity sensitivity(const ParametricNlp& problem, const Point& point);

}  // namespace tenon
