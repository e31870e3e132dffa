// Direct collocation: an optimal control problem as a nonlinear program, by the Radau IIA method with s = 1, 2 or 3 points.
//
//     stage k:   X_0  u  X_1 Y_1 .. Y_s  (interval k of its phase)      a phase ends in a stage of its own:  x(T_p)      globals:  free T_p
//
// Stages declare what belongs together, so that the solver eliminates the interior points inside their interval. A Dae without a Hessian
// is taken without its curvature (Gauss-Newton). Derivation: collocation.md.
#pragma once

#include <vector>

#include "tenon/core/nlp.hpp"
#include "tenon/core/ocp.hpp"
#include "tenon/core/plan.hpp"
#include "tenon/mpc/collocation_stage.hpp"

namespace tenon {

/// Of each phase the borders of its intervals, as fractions of its duration: 0 = f_0 < f_1 < ... < f_N = 1.
using Mesh = std::vector<std::vector<double>>;

/// Equal intervals, as many as the phases ask for.
Mesh uniform_mesh(const Ocp& ocp);

class Collocation final : public Nlp {
 public:
  /// Throws std::invalid_argument where the problem, the mesh or the number of points makes no sense.
  Collocation(Ocp ocp, int points, Mesh mesh);
  Collocation(const Ocp& ocp, int points) : Collocation(ocp, points, uniform_mesh(ocp)) {}

  const Ocp& ocp() const { return ocp_; }
  const Mesh& mesh() const { return mesh_; }
  const Radau& method() const { return method_; }

  /// The state in which the first phase starts from now on (nx).
  void set_initial_state(ConstVectorRef x);

  /// The solution as a function of time, and a point to start from that follows a plan of the same phases.
  Plan plan(ConstVectorRef x) const;
  void point_of(const Plan& plan, VectorRef x) const;

  /// Where a row or variable stands: its stage, and its fraction of its phase's duration; phase -1 for a duration.
  struct Place {
    int stage = 0, phase = 0;
    double fraction = 0;
  };
  Place place_of_row(int j) const;
  Place place_of_variable(int i) const;
  /// s: when that is, with the durations of the point.
  double time_of(const Place& place, ConstVectorRef x) const;

  int num_variables() const override { return num_variables_; }
  int num_constraints() const override { return num_rows_; }
  Stages stages() const override;
  SparsePattern jacobian_pattern() const override { return jacobian_pattern_; }
  SparsePattern hessian_pattern() const override { return hessian_pattern_; }
  HessianKind hessian_kind() const override { return ocp_.dae->has_hessian() ? HessianKind::exact : HessianKind::gauss_newton; }
  void bounds(Bounds& bounds) const override;
  void initial_point(VectorRef x) const override;
  Workspace make_workspace() const override;
  void prepare(ConstVectorRef x, Workspace& workspace) const override;
  double objective(ConstVectorRef x, Workspace& workspace) const override;
  void gradient(ConstVectorRef x, Workspace& workspace, VectorRef gradient) const override;
  void constraints(ConstVectorRef x, Workspace& workspace, VectorRef values) const override;
  void jacobian(ConstVectorRef x, Workspace& workspace, std::span<double> values) const override;
  void hessian(ConstVectorRef x, double sigma, ConstVectorRef lambda, Workspace& workspace, std::span<double> values) const override;
  std::string name() const override { return ocp_.name; }
  std::string variable_name(int i) const override;
  std::string constraint_name(int j) const override;

 private:
  struct StagePlace {
    int phase = 0, interval = 0;     // interval N: the end of the phase
    int kind = 0;                    // its functions, in kinds_
    double begin = 0, fraction = 0;  // of the phase
    int first_variable = 0, first_row = 0;
    std::vector<int> jacobian_positions, hessian_positions;  // of the entries of its kind in the patterns
  };
  /// Intervals of a phase share their functions.
  struct Kind {
    CollocationStage functions;
    std::vector<std::pair<int, int>> jacobian_entries, hessian_entries;  // each once
  };

  void add_stage(int phase, int interval, int kind);
  void find_patterns();
  const CollocationStage& functions(const StagePlace& stage) const { return kinds_[static_cast<std::size_t>(stage.kind)].functions; }
  const OcpPhase& phase(int p) const { return ocp_.phases[static_cast<std::size_t>(p)]; }
  bool is_end(const StagePlace& stage) const { return functions(stage).points() == 0; }
  int duration_variable(int phase) const { return duration_variables_[static_cast<std::size_t>(phase)]; }
  double duration(int phase, ConstVectorRef x) const {
    return duration_variable(phase) < 0 ? this->phase(phase).duration : x[duration_variable(phase)];
  }
  /// The variable behind an argument of a stage's functions.
  int variable(const StagePlace& stage, int argument) const {
    return argument < functions(stage).num_seen() ? stage.first_variable + argument : duration_variable(stage.phase);
  }
  std::size_t stage_of_variable(int i) const;
  std::size_t stage_of_row(int j) const;

  Ocp ocp_;
  Mesh mesh_;
  Radau method_;
  std::vector<Kind> kinds_;
  std::vector<StagePlace> stages_;
  std::vector<int> duration_variables_;  // -1 where it is fixed
  int num_variables_ = 0, num_rows_ = 0, first_global_ = 0;
  SparsePattern jacobian_pattern_, hessian_pattern_;
};

}  // namespace tenon
