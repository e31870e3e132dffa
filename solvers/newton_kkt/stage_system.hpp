// The KKT system of a problem with stages, in blocks: stage by stage, with the variables that belong to it.
//
//     w_k = (l, s):  s, its state: what the rows of the stage before touch, and the globals;   l: all else (inputs, interior variables)
//     rows of stage k:   A_l l + A_s s - s_{k+1} = r  (dynamics, one for each state of the next stage),    C_l l + C_s s + C_n s_{k+1} = r
//     (others)
//
// A stage whose dynamics are not of this explicit form has others only. Globals are carried along as states that do not move, so that
// the border is eliminated together with the last state. Slacks leave the system before all else: they add to the compliance of their
// rows. Equations: stage_kkt.md.
#pragma once

#include <vector>

#include "tenon/core/sparse_pattern.hpp"
#include "tenon/core/stages.hpp"
#include "tenon/solvers/newton_kkt/inertia.hpp"
#include "tenon/solvers/newton_kkt/multifrontal_ldlt.hpp"

namespace tenon {

/// One stage. Matrices are column-major, columns padded with zeros to whole lanes; all in one arena, stage behind stage.
struct StageBlocks {
  int locals = 0, states = 0;  // l; s with the globals
  int next_states = 0;         // states of the next stage, with the globals; 0 at the last one
  int rows = 0;                // rows that are not dynamics
  int own_next_states = 0;     // next_states without the globals
  bool is_explicit = false;    // whether the dynamics give every own state of the next stage
  int state_stride = 0, local_stride = 0, next_stride = 0;

  double *h_ss = nullptr, *h_sl = nullptr, *h_ll = nullptr;                 // Hessian with sigma: both triangles
  double *a_s = nullptr, *a_l = nullptr, *at_s = nullptr, *at_l = nullptr;  // dynamics, and transposed
  double *c_s = nullptr, *c_l = nullptr, *c_n = nullptr;                    // transposed other rows: one column each
  double *h_ns = nullptr, *h_nl = nullptr;                                  // Hessian between the next state and this stage (not explicit)
  double* value = nullptr;                                                  // P: what the stages from here on add to the state's Hessian
  double *gain = nullptr, *l_ll = nullptr, *d_inverse = nullptr;            // factor of the locals: M_ll = L D L', gain = M_sl M_ll^-1

  int at_l_vector = 0, at_s_vector = 0, at_dynamics = 0, at_rows = 0;  // where l, s, the dynamics and the other rows are in a vector
};

class StageSystem {
 public:
  /// hessian: lower triangle, n x n; jacobian: m x n. Throws std::invalid_argument where an entry couples what stages may not couple, or
  /// the stages leave a variable or row out.
  StageSystem(const Stages& stages, const SparsePattern& hessian, const SparsePattern& jacobian);

  /// False where a number is not finite. sigma: n; d: m.
  bool assemble(const SparseMatrix& hessian, const SparseMatrix& jacobian, ConstVectorRef sigma, ConstVectorRef d);

  int n() const { return n_; }
  int m() const { return m_; }
  int size() const { return static_cast<int>(stages_.size()); }
  int globals() const { return globals_; }
  int vector_size() const { return vector_size_; }
  StageBlocks& stage(int k) { return stages_[k]; }
  const StageBlocks& stage(int k) const { return stages_[k]; }

  /// Of the slacks' pivots.
  const Inertia& slack_inertia() const { return slack_inertia_; }

  /// D of the rows (scaled, with what slacks give), 0 at variables.
  const double* compliance() const { return compliance_.data(); }
  /// Coupling of each row of dynamics to its next state: -1, or 0 where that is fixed.
  const double* link() const { return link_.data(); }
  /// Whether all states of the first stage are fixed: nothing is left to solve for when the others are eliminated.
  bool first_state_is_fixed() const { return fixed_states_[0] == stage(0).states; }

  /// Right-hand sides and solutions between the order of the problem and that of the stages.
  void gather(ConstVectorRef r_x, ConstVectorRef r_c, double* vector) const;
  void scatter(const double* vector, ConstVectorRef r_x, VectorRef dx, VectorRef dlambda) const;

 private:
  struct Place {
    int first, mirror;
  };
  struct Run {  // entries of the Jacobian in their order
    int source, place, length;
  };
  struct Link {  // the coefficient of a next state
    int source, place;
  };
  struct Slack {
    int variable, row, coefficient;
    int curvature = -1;  // its entry of the Hessian, if any
    double pull = 0;     // coefficient / pivot
    double inverse = 0;  // 1 / pivot; 0 where it is fixed
  };
  void find_slacks(const Stages& stages, const SparsePattern& hessian, const SparsePattern& jacobian);
  void find_states(const Stages& stages, const SparsePattern& jacobian);
  void find_dynamics(const Stages& stages, const SparsePattern& hessian, const SparsePattern& jacobian);
  void reserve();
  void place_hessian(const SparsePattern& hessian);
  void place_jacobian(const SparsePattern& jacobian);
  bool holds(const SparseMatrix& jacobian) const;
  bool place(const SparseMatrix& jacobian);
  void scale_dynamics();
  void find_fixed(ConstVectorRef sigma);
  void eliminate_slacks(const SparseMatrix& hessian, const SparseMatrix& jacobian, ConstVectorRef sigma);
  void take_out(int variable);
  int offset(const double* place) const { return static_cast<int>(place - arena_.data()); }

  struct Home {      // of a variable
    int stage = -1;  // the last one for a global
    int local = -1;  // its index among the locals, or -1
    int state = -1;  // its index among the states
    bool is_slack() const { return local < 0 && state < 0; }
  };

  int n_, m_, globals_;
  std::vector<StageBlocks> stages_;
  std::vector<Home> homes_;
  std::vector<int> row_stage_, row_dynamics_;  // of a row: its stage, its index among the dynamics or -1
  std::vector<int> row_other_;                 // its index among the others, or -1
  Eigen::Matrix<double, Dynamic, 1> arena_;
  std::vector<Place> hessian_places_;
  std::vector<Run> jacobian_runs_;
  std::vector<Link> links_;
  std::vector<Slack> slacks_;
  Inertia slack_inertia_;
  std::vector<int> diagonal_places_, bare_diagonals_;
  std::vector<int> variable_places_, row_places_;  // in a vector
  std::vector<int> fixed_states_;  // of each stage: how many
  std::vector<int> fixed_, fixed_before_;
  int vector_size_ = 0, at_slacks_ = 0;  // the last lane of a vector stands for all slacks, and is 0
  Vector compliance_, link_, row_scale_;
  Vector placed_;  // the Jacobian's values that the blocks hold
  bool scaled_ = false, holds_jacobian_ = false;
};

}  // namespace tenon
