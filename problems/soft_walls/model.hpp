// A pole on a cart, near upright, between two soft walls that its tip runs into: linear in each contact mode.
//
//     x+ = A x + B u + D lambda,     0 <= lambda  _|_  E x + F lambda + c >= 0,     F = I / k
//
// x = (position, angle, velocity, angular velocity), u the force on the cart, lambda the walls' forces on the tip; since F is diagonal,
// lambda_i = k max(0, -(E x + c)_i). The standard test of control through contact [Aydinoglu, Posa, Consensus complementarity control for
// multi-contact MPC, IEEE Trans. Robotics 40 (2024)].
#pragma once

#include "tenon/core/eigen.hpp"

namespace tenon::soft_walls {

using State = Eigen::Vector4d;

/// SI units throughout.
struct Parameters {
  double pole_mass = 0.411, cart_mass = 0.978;
  double pole_length = 0.6, com_length = 0.4267;  // from the joint to the tip, to the centre of mass
  double wall = 0.35;                             // the tip's position where it touches, on either side
  double stiffness = 100;
  double gravity = 9.81;
  double step = 0.01;
};

class Model {
 public:
  /// Throws std::invalid_argument where a mass, a length, the stiffness or the step is not positive.
  explicit Model(const Parameters& parameters = {});

  const Parameters& parameters() const { return parameters_; }
  const Eigen::Matrix4d& a() const { return a_; }
  const State& b() const { return b_; }
  /// Of the first wall's force; the second pushes the other way.
  const State& d() const { return d_; }
  /// The tip's position is this times x.
  const State& tip() const { return tip_; }

  /// lambda_1 - lambda_2 where the tip is at p.
  double wall_force(double p) const;
  State next(const State& x, double u) const { return a_ * x + b_ * u + d_ * wall_force(tip_.dot(x)); }

 private:
  Parameters parameters_;
  Eigen::Matrix4d a_;
  State b_, d_, tip_;
};

struct Weights {
  State state{10, 2, 1, 1};  // diagonal of Q
  double input = 1;          // R
};

/// P = Q + A' P A - A' P B (R + B' P B)^-1 B' P A, by iteration from Q. Throws std::invalid_argument where it does not converge.
Eigen::Matrix4d riccati_solution(const Model& model, const Weights& weights);

/// K = (R + B' P B)^-1 B' P A of the regulator u = -K x.
Eigen::RowVector4d regulator_gain(const Model& model, const Weights& weights, const Eigen::Matrix4d& p);

}  // namespace tenon::soft_walls
