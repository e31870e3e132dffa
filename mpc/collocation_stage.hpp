// One stage of a collocated phase as a small dense problem of its own variables: an interval, or the end of the phase.
//
//     interval:   v = ( X_0  u  X_1 Y_1 .. X_{s-1} Y_{s-1}  Y_s | X_s | T )       F at every point, g, contacts
//     end:        v = ( x | x of the next phase )                                 e, link
//
// What stands behind the first bar belongs to the next stage, so that v is a piece of the program's x; T, a free duration, is the last
// argument. Equations: collocation.md.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tenon/core/ocp.hpp"
#include "tenon/mpc/radau.hpp"

namespace tenon {

/// A function of some of the stage's variables: part of the objective, or rows.
struct StageTerm {
  std::shared_ptr<const SmoothFunction> function;
  std::vector<int> arguments;  // indices in v
  std::string name;            // of its rows
  int point = 0;               // of the collocation, for names
  int first_row = -1;          // -1: part of the objective
  double weight = 1;           // in the objective
  bool is_integrand = false;   // the weight is times the interval's length
  int factors = -1;            // index in v of lambda_1: the rows are lambda_k f_k
  int subtracted = -1;         // index in v of z_1: the rows are f_k - z_k
};

class CollocationStage {
 public:
  using Matrix = SmoothFunction::Matrix;

  static CollocationStage interval(const Ocp& ocp, int phase, const Radau& method);
  /// has_next: another phase follows.
  static CollocationStage end(const Ocp& ocp, int phase, bool has_next);

  int num_own() const { return own_; }    // variables of the stage itself
  int num_seen() const { return seen_; }  // with those of the next one that it touches, without T
  int num_arguments() const { return seen_ + (has_duration_ ? 1 : 0); }
  int num_rows() const { return num_rows_; }
  const Box& rows_box() const { return rows_box_; }

  int x_at(int i) const { return i == 0 ? 0 : i < points() ? nx_ + nu_ + (i - 1) * (nx_ + ny_) : own_; }
  int y_at(int i) const { return i < points() ? x_at(i) + nx_ : own_ - ny_; }
  int u_at() const { return nx_; }
  int points() const { return method_.points; }

  /// Where its derivatives may be non-zero: (row, argument), and (argument, argument) on and below the diagonal; repetitions allowed.
  std::vector<std::pair<int, int>> jacobian_entries() const;
  std::vector<std::pair<int, int>> hessian_entries() const;

  /// Where a stage is evaluated, with the storage that this takes.
  struct At {
    const double* v = nullptr;                    // num_seen
    double t = 0;                                 // s, at its start
    double duration = 0;                          // s, of the phase
    double fraction = 0;                          // of the phase that the interval takes
    Eigen::MatrixXd xdot = {};                    // nx x s
    std::vector<Dae::Workspace> workspaces = {};  // one for each point

    double length() const { return duration * fraction; }
  };
  /// Temporary storage, shared by all stages.
  struct Storage {
    Vector z, f, multipliers;
    Eigen::MatrixXd jacobian, hessian;
    std::vector<double> without_alpha, with_alpha, of_inputs, curvature;
  };
  At make_at() const;
  void reserve(Storage& storage) const;

  void prepare(At& at) const;
  double objective(const At& at, Storage& storage) const;
  void add_gradient(const At& at, Storage& storage, double* gradient_of_v, double* gradient_of_duration) const;
  void rows(At& at, Storage& storage, VectorRef values) const;
  /// Dense, num_rows x num_arguments; lower triangle of num_arguments^2.
  void jacobian(At& at, Storage& storage, Matrix jacobian) const;
  void hessian(At& at, Storage& storage, double sigma, ConstVectorRef lambda, Matrix hessian) const;

  /// `k`: the number of the interval.
  std::string variable_name(int i, int k) const;
  std::string row_name(int j, int k) const;
  /// The collocation point, 0 for the start of the interval.
  int point_of_row(int j) const;
  int point_of_variable(int i) const;

 private:
  explicit CollocationStage(const Ocp& ocp, int phase);
  void add_term(StageTerm term, const Box& box);
  void add_contacts(const Complementarity& contact);
  std::vector<int> arguments_at(int i, bool with_y_and_u) const;
  int duration_index() const { return seen_; }
  int rows_of_point() const { return nx_ + ny_; }
  DaePoint point(const At& at, int i) const;
  void gather(const StageTerm& term, const At& at, Storage& storage) const;
  void differentiate_dynamics(At& at, Storage& storage, int i, double alpha) const;
  void add_dynamics_hessian(At& at, Storage& storage, ConstVectorRef lambda, Matrix hessian) const;
  void add_duration_hessian(At& at, Storage& storage, int i, ConstVectorRef weights, double alpha, Matrix hessian) const;
  void add_term_hessian(const StageTerm& term, const At& at, Storage& storage, double sigma, ConstVectorRef lambda, Matrix hessian) const;

  std::shared_ptr<const Dae> dae_;
  DaeMode mode_;
  std::string prefix_;  // of names, where there are several phases
  Radau method_;        // of no point: the end of a phase
  int nx_, ny_, nu_;
  int own_ = 0, seen_ = 0, num_rows_ = 0;
  bool has_duration_ = false, has_curvature_ = false;
  std::vector<StageTerm> terms_;
  Box rows_box_;
  SparsePattern jacobian_pattern_, rate_pattern_, input_pattern_, hessian_pattern_;
  std::vector<int> rate_places_;  // of the entries of rate_pattern_ in jacobian_pattern_
};

}  // namespace tenon
