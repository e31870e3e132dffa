// A pendulum on a cart, to be swung up by a bounded force: direct multiple shooting with one step of the classical Runge-Kutta method for
// each interval. Two known instances of it are cart_pole() and pendulum().
//
//     min  1/2 sum_k ( x_k' Q x_k + R u_k^2 ) + 1/2 x_N' Q_N x_N      s.t.   F(x_k, u_k) - x_{k+1} = 0,   |u_k| <= u_max
//
// x = (position, angle, velocity, angular velocity); the variables are ordered x_0 u_0 x_1 u_1 ... x_N, the rows by interval. Derivatives
// are exact and by hand, four intervals at a time: swing_up.md.
#pragma once

#include <array>
#include <optional>

#include "tenon/core/nlp.hpp"

namespace tenon {

struct SwingUpProgram {
  using State = std::array<double, 4>;

  std::string name = {};
  double cart_mass = 1, pole_mass = 1;                                               // kg
  double length = 1;                                                                 // m, to the bob
  double gravity = 9.81;                                                             // m/s^2
  bool zero_is_upright = false;                                                      // where the angle is counted from
  double duration = 1;                                                               // s
  int intervals = 20;                                                                // N
  State state_weight = {}, final_weight = {};                                        // diagonals of Q and Q_N
  double input_weight = 0;                                                           // R
  double largest_input = kInfinity<double>;                                          // N
  double least_position = -kInfinity<double>, largest_position = kInfinity<double>;  // m
  State initial = {};
  std::optional<State> final = {};  // where the end is prescribed
  bool gauss_newton = false;        // the Hessian without the curvature of the dynamics
};

class SwingUp final : public Nlp {
 public:
  using StageSizes = tenon::StageSizes<4, 1>;

  /// Throws std::invalid_argument where there is no interval, or the duration is not positive.
  explicit SwingUp(SwingUpProgram program);

  /// The state from which the next solves start.
  void set_initial_state(const SwingUpProgram::State& state) { program_.initial = state; }
  const SwingUpProgram& program() const { return program_; }

  int num_variables() const override { return 5 * program_.intervals + 4; }
  int num_constraints() const override { return 4 * program_.intervals; }
  Stages stages() const override;
  SparsePattern jacobian_pattern() const override;
  SparsePattern hessian_pattern() const override;
  void bounds(Bounds& bounds) const override;

  /// Position and angle on a straight line to the prescribed end, all else 0; without one, at rest where it begins.
  void initial_point(VectorRef x) const override;
  Workspace make_workspace() const override;
  void prepare(ConstVectorRef x, Workspace& workspace) const override;
  double objective(ConstVectorRef x, Workspace& workspace) const override;
  void gradient(ConstVectorRef x, Workspace& workspace, VectorRef gradient) const override;
  void constraints(ConstVectorRef x, Workspace& workspace, VectorRef values) const override;
  void jacobian(ConstVectorRef x, Workspace& workspace, std::span<double> values) const override;
  void hessian(ConstVectorRef x, double sigma, ConstVectorRef lambda, Workspace& workspace, std::span<double> values) const override;
  std::string name() const override { return program_.name; }
  std::string variable_name(int i) const override;
  std::string constraint_name(int j) const override;

 private:
  double step() const { return program_.duration / program_.intervals; }

  SwingUpProgram program_;
};

/// Swing-up from rest at (0, 0) to rest at (1, pi) in 5 s with least effort; local optima 11181.3177 and 11190.6966 at N = 100.
SwingUpProgram cart_pole(int intervals = 100);

/// Swing-up in 1 s by tracking weights, from hanging, without a prescribed end; optimum 2242.828131 at N = 20.
SwingUpProgram pendulum(int intervals = 20);

}  // namespace tenon
