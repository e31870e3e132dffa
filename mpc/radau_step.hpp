// One step of a Radau IIA method, its stages found by Newton's method: what a plan is compared with.
//
//     F(xdot_i, X_i, Y_i, u) = 0,    xdot_i = (1/h) sum_j D_ij X_j,    i = 1 .. s                                collocation.md (1)
#pragma once

#include <vector>

#include "tenon/core/dae.hpp"
#include "tenon/mpc/radau.hpp"

namespace tenon {

class RadauStep {
 public:
  /// The Dae must outlive it.
  RadauStep(const Dae& dae, int points);

  const Radau& method() const { return method_; }
  /// Storage for what to start from: states at the abscissae (nx x (s + 1), the first of them is where the step begins) and algebraic
  /// variables (ny x s). After a step they hold its solution.
  Eigen::MatrixXd x, y;

  /// From t over h with this input. False where Newton's method does not converge.
  bool advance(const DaeMode& mode, double t, double h, ConstVectorRef u);

 private:
  void evaluate(const DaeMode& mode, double t, double h, ConstVectorRef u);

  const Dae& dae_;
  Radau method_;
  Dae::Workspace workspace_;
  SparsePattern pattern_;
  std::vector<double> without_alpha_, with_alpha_;
  Eigen::MatrixXd matrix_;  // s (nx + ny) square
  Vector residual_;
};

}  // namespace tenon
