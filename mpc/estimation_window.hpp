// The last N intervals of an estimation problem as a nonlinear program whose stages are those intervals.
//
//     min   1/2 |W (xi_0 - m)|^2 + 1/2 sum |r_k(x_k)|^2 + 1/2 sum |w_k|^2        s.t.   phi_k(xi_k, w_k) - xi_{k+1} = 0
//
//     xi: x, or the logarithm of what is positive, in units s of the prior's deviations
//     r_k = (h(x_k) - y_k) / noise           phi_k: where x leads, as xi
//     w_k: ripple of the commands and drift, in their deviations
//
// The squares of prior and measurements are rows that give way (compliance 1), so that their multipliers are the residuals. What was not
// measured has weight 0. Variables are ordered xi_0 w_0 xi_1 ... xi_N, rows: prior, then r_k and the dynamics by interval. Hessian: Gauss
// and Newton's. Derivation: moving_horizon.md.
#pragma once

#include <vector>

#include "tenon/core/estimation_problem.hpp"
#include "tenon/core/nlp.hpp"
#include "tenon/mpc/gaussian_belief.hpp"
#include "tenon/mpc/state_transition.hpp"

namespace tenon {

class EstimationWindow final : public Nlp {
 public:
  /// Before anything was measured: every interval 0 s long, the prior at its first instant. The problem must outlive it.
  explicit EstimationWindow(const EstimationProblem& problem);

  int intervals() const { return intervals_; }
  /// Where xi_k stands among the variables.
  int state_at(int k) const { return k * stride_; }
  /// x of xi, and dx/dxi, entry by entry.
  void to_state(ConstVectorRef xi, VectorRef x, VectorRef slope) const;

  void reset();
  /// `commands` held for `dt` s, then these measurements (not finite: not measured) at the last instant of the window; the first leaves it,
  /// and what it said stays as prior of the next: by the derivatives at `x`, where the window was solved. Allocates nothing.
  void slide(ConstVectorRef x, double dt, ConstVectorRef commands, ConstVectorRef measurements);
  /// A point of the window before as one of this: everything an interval earlier, the last interval without drift.
  void shift(Vector& x, Vector& lambda);
  /// The initial point, without an allocation.
  void start(Vector& x);

  /// What is believed of xi at the last instant, by the derivatives at x.
  const GaussianBelief& belief(ConstVectorRef x);

  int num_variables() const override { return intervals_ * stride_ + nx_; }
  int num_constraints() const override { return nx_ + intervals_ * (ny_ + nx_) + ny_; }
  Stages stages() const override;
  SparsePattern jacobian_pattern() const override;
  SparsePattern hessian_pattern() const override;
  HessianKind hessian_kind() const override { return HessianKind::gauss_newton; }
  void bounds(Bounds& bounds) const override;
  /// The prior's mean, and where it leads.
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

 private:
  /// An instant: what was measured, and the interval that led to it.
  struct Instant {
    double dt = 0;  // s
    Vector commands, measured, weights;
  };
  /// r_k and phi_k but for drift, with their derivatives: the gradient of each residual as a column, A by xi_k, G by the ripple.
  struct Linearised {
    Vector residual, next;
    Eigen::MatrixXd gradients, a, g;
  };
  /// Storage of an evaluation, and its outcome at every instant.
  struct Evaluation final : Scratch {
    Evaluation(const EstimationProblem& problem, int nx, int ny, int ripples, int instants)
        : transition(*problem.dae, problem.mode, problem.longest_step),
          z(problem.measured->num_arguments()),
          slope(nx),
          surprise(nx),
          by_z(ny, z.size()),
          command(problem.dae->num_inputs()),
          at(std::size_t(instants), {Vector::Zero(ny), Vector::Zero(nx), Eigen::MatrixXd::Zero(nx, ny), Eigen::MatrixXd::Zero(nx, nx),
                                     Eigen::MatrixXd::Zero(nx, ripples)}) {}

    StateTransition transition;
    Vector z, slope;       // (x, u); dx/dxi
    Vector surprise;       // xi_0 - m
    Eigen::MatrixXd by_z;  // of h
    Vector command;        // with its ripple
    std::vector<Linearised> at;
  };

  int rows_at(int k) const { return nx_ + k * (ny_ + nx_); }
  const Instant& instant(int k) const { return instants_[static_cast<std::size_t>(k)]; }
  /// Of the variables x of all instants, those of instant k; nothing ripples after the last.
  ConstVectorRef state(ConstVectorRef x, int k) const { return x.segment(state_at(k), nx_); }
  ConstVectorRef ripple(ConstVectorRef x, int k) const { return x.segment(state_at(k) + nx_, static_cast<int>(rippling_.size())); }
  void linearise(int k, ConstVectorRef x, Evaluation& at, Linearised& out) const;
  void learn(int k, ConstVectorRef x, const Linearised& at, GaussianBelief& belief) const;
  void move(int k, ConstVectorRef x, const Linearised& at, GaussianBelief& belief);
  void start(VectorRef x, Evaluation& evaluation) const;
  void lead_on(int k, VectorRef x, Evaluation& evaluation) const;
  /// Back to the prior of the beginning.
  void forget();
  /// False where the prior is no Gaussian any more.
  bool whiten();
  double drift(int i, int k) const;  // of state i over interval k

  const EstimationProblem& problem_;
  int nx_, ny_, intervals_, nw_, stride_;
  std::vector<int> rippling_, drifting_;  // commands, states
  Vector scale_;                          // s
  std::vector<Instant> instants_;
  GaussianBelief prior_, now_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
  Eigen::MatrixXd whitening_;  // W, the inverse of the factor
  Vector variance_;
  Workspace own_;
};

}  // namespace tenon
