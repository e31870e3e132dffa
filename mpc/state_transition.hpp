// Where a Dae takes a state under held inputs, and how that moves with the state it starts from and with the inputs.
//
//     x' = f(x, u),    S' = df/dx S + [0, df/du],  S(0) = [I, 0]       by Runge and Kutta's classical method, on both alike
//
// For a Dae without algebraic variables whose F is xdot - f(x, u).
#pragma once

#include <array>
#include <vector>

#include "tenon/core/dae.hpp"

namespace tenon {

class StateTransition {
 public:
  /// The Dae must outlive it; steps of `longest_step` (s) at most.
  StateTransition(const Dae& dae, const DaeMode& mode, double longest_step);

  /// From x over dt (s); afterwards `state` and `derivative` (nx x (nx + nu)) hold where that leads. dt = 0 leads nowhere. Allocates
  /// nothing.
  void advance(ConstVectorRef x, ConstVectorRef u, double dt);

  Vector state;
  Eigen::MatrixXd derivative;

 private:
  void rates(std::size_t stage, ConstVectorRef u);
  void step(double h, ConstVectorRef u);

  const Dae& dae_;
  const DaeMode& mode_;
  double longest_step_;
  Dae::Workspace workspace_;
  SparsePattern pattern_, input_pattern_;
  std::vector<double> values_, input_values_;
  Vector at_, none_;
  Eigen::MatrixXd moved_, by_x_;                    // S at a stage, df/dx
  std::array<Vector, 4> rate_;                      // k_i
  std::array<Eigen::MatrixXd, 4> derivative_rate_;  // K_i
};

}  // namespace tenon
