// Peg in hole over a receding horizon: where the peg goes next and what touches it, so that the reference of an impedance loop follows.
//
//     min  sum over intervals of  tracking + lateral error + spring force + rate of the reference + contact forces            (2.7)
//     s.t. M v' = K (r - q) + D (r' - v) + sum_i grad h_i(q) lambda_i   by implicit Euler,   h_i >= 0,   lambda_i h_i <= eps,
//          reference rates and spring forces bounded                                                                       peg_in_hole.md
//
// Decided are the velocity at an interval's end and the contact forces over it; the momentum balance then gives the reference, so that the
// dynamics are explicit and every stage is a step of a Riccati recursion. Inside: mm, 100 mm/s, N. SI outside.
#pragma once

#include "tenon/core/horizon_program.hpp"
#include "tenon/problems/peg_in_hole/geometry.hpp"
#include "tenon/problems/peg_in_hole/impedance.hpp"

namespace tenon::peg {

struct AssemblyProblem {
  std::string name = "peg-in-hole";
  Geometry geometry;
  Impedance impedance;
  double interval = 0.02;        // s
  int intervals = 15;            // N
  double smoothing = 0.02;       // mm, delta of the gaps
  double complementarity = 0.01; // N mm, eps
  double largest_force = 60;     // N, of a contact
  double largest_spring = 10.5;  // N, of the impedance, in x and z
  double largest_rate = 40;      // mm/s, of the reference
  double speed = 25;             // mm/s, downwards
  double depth = 20.3;           // mm, aimed at
  bool follow_hole = true;       // false: the peg is to stay where x and phi began, and contact must do the work
  double guessed_force = 0;      // N, of every contact in the initial point
  Vector3d pose{0, 5, 0};        // until something is observed
  Vector3d hole{0, 0, 0};
};

class AssemblyProgram final : public HorizonProgram {
 public:
  using StageSizes = tenon::StageSizes<12, 9>;

  /// Throws std::invalid_argument where there is no interval, or its length is not positive.
  explicit AssemblyProgram(const AssemblyProblem& problem);

  int num_measurements() const override;
  int num_estimates() const override { return 3; }
  int num_commands() const override;
  double interval() const override { return problem_.interval; }

  /// Measurements and estimates as in channels.hpp.
  void observe(double t, ConstVectorRef measurements, ConstVectorRef estimates) override;
  /// Where the peg has got no further for a while: a plan that stays where it is may be a local optimum, and tends to remain one. And where
  /// the hole turns out to be elsewhere: the plan for the former place goes through a wall.
  bool wants_fresh_start() const override { return is_jammed_ || hole_has_moved_; }
  void commands(const Point& plan, double elapsed, VectorRef commands) const override;
  std::string command_name(int i) const override;
  /// Where the peg is at the end of each interval: x, z (m), theta (rad).
  int num_plan_outputs() const override { return 3 * problem_.intervals; }
  std::string plan_output_name(int i) const override;
  void plan_outputs(const Point& plan, VectorRef values) const override;
  std::vector<std::string> trajectory_columns() const override;
  void trajectory(const Point& plan, int k, VectorRef values) const override;

  int num_variables() const override { return kStage * problem_.intervals + kStates; }
  int num_constraints() const override { return kRows * problem_.intervals; }
  Stages stages() const override;
  SparsePattern jacobian_pattern() const override;
  SparsePattern hessian_pattern() const override;
  void bounds(Bounds& bounds) const override;

  /// The peg goes to the hole's axis, and down at the speed asked for wherever that is free; above the hole, down whatever is in its way.
  void initial_point(VectorRef x) const override;
  Workspace make_workspace() const override;
  void prepare(ConstVectorRef x, Workspace& workspace) const override;
  double objective(ConstVectorRef x, Workspace& workspace) const override;
  void gradient(ConstVectorRef x, Workspace& workspace, VectorRef gradient) const override;
  void constraints(ConstVectorRef x, Workspace& workspace, VectorRef values) const override;
  void jacobian(ConstVectorRef x, Workspace& workspace, std::span<double> values) const override;
  void hessian(ConstVectorRef x, double sigma, ConstVectorRef lambda, Workspace& workspace, std::span<double> values) const override;
  std::string name() const override { return problem_.name; }
  std::string variable_name(int i) const override;
  std::string constraint_name(int j) const override;

  const AssemblyProblem& problem() const { return problem_; }

 private:
  // of a stage: the pose q, its rate v, the spring r - q, the rate u of the reference in the interval before; then the rate w at the end of the
  // interval and the contact forces
  static constexpr int kPose = 0, kVelocity = 3, kSpring = 6, kRate = 9, kStates = 12, kNext = 12, kForces = 15, kStage = 21;
  static constexpr double kUnitOfRate = 100, kMillimetre = 1e-3;  // mm/s; m
  static constexpr int kGaps = 12, kProducts = 18, kRows = 24;

  struct Contacts;
  struct Interval;
  double wanted_height(int k) const;
  Vector3d next_on_the_way(const Vector3d& pose) const;
  void watch_progress(double t);

  AssemblyProblem problem_;
  Vector3d inertia_;        // m = M / dt, N for each 100 mm/s
  Vector3d keep_, yield_;   // a and b of (2.3): what of a spring is left after an interval, and what a force adds
  double step_;             // c, mm for each 100 mm/s
  Vector3d pose_, velocity_, spring_, rate_, hole_, lateral_;
  double progress_height_ = 0, progress_time_ = 0;  // mm, s: where and when the peg was last seen to have got on
  bool is_jammed_ = false, hole_has_moved_ = false;
};

/// A single plan of 1.2 s into a hole that lies 0.9 mm and 1 degree beside the peg's path.
AssemblyProblem single_plan();

}  // namespace tenon::peg
