// A wrist brought down onto a plane and pressed against it, looked ahead N intervals: force only where there is contact.
//
//     z'' = w - lambda/m, both held over an interval;      gap h = z_p - z (z down);      r = h + (2 p h' + h'')/p^2
//
//     min  sum_k dt [ (z - z_p)^2 + q_w (w - F/m)^2 + q_f (lambda - F)^2 ] + q_d (w_k - w_{k-1})^2 + terminal
//     s.t.   r_k >= 0,   0 <= lambda,   lambda_k r_k <= eps,   lambda_k h_k <= eps,   lambda_k h_{k+1} <= eps
//
// r >= 0 makes the approach soft by construction (the gap closes no faster than with the double pole -p); the products with the gap at both
// ends of an interval allow no force before it closes. The pair alone, 0 <= lambda _|_ r >= 0, is there for comparison. touch_down.md
#pragma once

#include "tenon/core/horizon_program.hpp"

namespace tenon::touch_down {

/// SI units; the program itself counts in cm, dm/s, m/s^2 and N.
struct Parameters {
  enum class Contact {
    gap,   // products with the gap at both ends, and with r
    pair,  // the product with r alone: permits force at a distance
  };
  Contact contact = Contact::gap;
  int intervals = 25;
  double step = 0.02;
  double mass = 0.6;
  double pole = 20;             // p, 1/s
  double slack = 1e-4;          // eps, N m
  double largest_input = 15;    // |w|
  double largest_force = 60;
  double input_weight = 1e-3, change_weight = 1e-4, force_weight = 0.05;  // q_w, q_d, q_f, in the program's units
};

/// Measured: z, v, contact force, its peak in the tick, w. Estimated: z_p, F.
class Horizon final : public HorizonProgram {
 public:
  using StageSizes = tenon::StageSizes<3, 2>;

  /// `start` (m) and `plane` (m) are observed until others are. Throws std::invalid_argument.
  Horizon(const Parameters& parameters, double start, double plane);

  int num_measurements() const override { return 5; }
  int num_estimates() const override { return 2; }
  int num_commands() const override { return 1; }
  double interval() const override { return parameters_.step; }
  void observe(double t, ConstVectorRef measurements, ConstVectorRef estimates) override;
  void commands(const Point& plan, double elapsed, VectorRef commands) const override;
  std::string command_name(int) const override { return "w"; }
  /// Position (m) at the end of each interval, force (N) over it.
  int num_plan_outputs() const override { return 2 * parameters_.intervals; }
  std::string plan_output_name(int i) const override;
  void plan_outputs(const Point& plan, VectorRef values) const override;
  std::vector<std::string> trajectory_columns() const override;
  void trajectory(const Point& plan, int k, VectorRef values) const override;

  int num_variables() const override { return kStage * parameters_.intervals + kStates; }
  int num_constraints() const override { return kRows * parameters_.intervals; }
  Stages stages() const override;
  SparsePattern jacobian_pattern() const override;
  SparsePattern hessian_pattern() const override;
  void bounds(Bounds& bounds) const override;
  /// Straight down to the plane, a little force.
  void initial_point(VectorRef x) const override;
  double objective(ConstVectorRef x, Workspace& workspace) const override;
  void gradient(ConstVectorRef x, Workspace& workspace, VectorRef gradient) const override;
  void constraints(ConstVectorRef x, Workspace& workspace, VectorRef values) const override;
  void jacobian(ConstVectorRef x, Workspace& workspace, std::span<double> values) const override;
  void hessian(ConstVectorRef x, double sigma, ConstVectorRef lambda, Workspace& workspace, std::span<double> values) const override;
  std::string name() const override { return "delta-touch-down"; }
  std::string variable_name(int i) const override;
  std::string constraint_name(int j) const override;

 private:
  // of a stage: z, v, the w before, and behind these w and lambda; rows of the dynamics, then of the contact
  static constexpr int kStates = 3, kStage = 5, kDynamics = 3, kRows = 7;
  using Row = Eigen::Matrix<double, 1, kStage>;

  Row barrier_row() const;
  Row next_gap_row() const;

  Parameters parameters_;
  double dt_;
  Eigen::Vector3d start_ = Eigen::Vector3d::Zero();  // z, v, w in the program's units
  double plane_, force_ = 0;                         // cm, N
};

}  // namespace tenon::touch_down
