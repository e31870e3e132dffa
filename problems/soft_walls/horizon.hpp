// The pole between soft walls, looked ahead N steps: the walls' law stands in the dynamics, its corner rounded.
//
//     min  sum_k ( x_k' Q x_k + R u_k^2 ) + x_N' P x_N      s.t.   A x_k + B u_k + D f(p_k) - x_{k+1} = 0,   p = tip of x
//
//     f(p) = k ( r(p - w) - r(-p - w) ),     r(s) = (s + sqrt(s^2 + delta^2)) / 2
//
// Variables are ordered x_0 u_0 x_1 ... x_N, rows by interval. Why this form and not the complementary one: soft_walls.md.
#pragma once

#include "tenon/core/horizon_program.hpp"
#include "tenon/problems/soft_walls/model.hpp"

namespace tenon::soft_walls {

class Horizon final : public HorizonProgram {
 public:
  using StageSizes = tenon::StageSizes<4, 1>;

  /// `intervals` N >= 1; `rounding` delta, m, > 0; `start` is observed until another state is. Throws std::invalid_argument.
  Horizon(const Model& model, const Weights& weights, int intervals, double rounding, const State& start);

  int num_measurements() const override { return 4; }
  int num_commands() const override { return 1; }
  double interval() const override { return model_.parameters().step; }
  void observe(double t, ConstVectorRef measurements, ConstVectorRef estimates) override;
  void commands(const Point& plan, double elapsed, VectorRef commands) const override;
  std::string command_name(int) const override { return "u"; }
  /// Cart, angle and tip at the end of each interval.
  int num_plan_outputs() const override { return 3 * intervals_; }
  std::string plan_output_name(int i) const override;
  void plan_outputs(const Point& plan, VectorRef values) const override;
  std::vector<std::string> trajectory_columns() const override;
  void trajectory(const Point& plan, int k, VectorRef values) const override;

  int num_variables() const override { return 5 * intervals_ + 4; }
  int num_constraints() const override { return 4 * intervals_; }
  Stages stages() const override;
  SparsePattern jacobian_pattern() const override;
  SparsePattern hessian_pattern() const override;
  void bounds(Bounds& bounds) const override;
  /// The state rolled out under the law of the terminal cost, walls included.
  void initial_point(VectorRef x) const override;
  double objective(ConstVectorRef x, Workspace& workspace) const override;
  void gradient(ConstVectorRef x, Workspace& workspace, VectorRef gradient) const override;
  void constraints(ConstVectorRef x, Workspace& workspace, VectorRef values) const override;
  void jacobian(ConstVectorRef x, Workspace& workspace, std::span<double> values) const override;
  void hessian(ConstVectorRef x, double sigma, ConstVectorRef lambda, Workspace& workspace, std::span<double> values) const override;
  std::string name() const override { return "cart-pole-soft-walls"; }
  std::string variable_name(int i) const override;

 private:
  Model model_;
  Weights weights_;
  int intervals_;
  double rounding_;
  State start_;
  Eigen::Matrix4d terminal_;  // P
  Eigen::RowVector4d gain_;   // u = -K x, of the same equation
};

}  // namespace tenon::soft_walls
