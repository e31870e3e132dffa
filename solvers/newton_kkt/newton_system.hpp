// The Newton system of the barrier problem: assembled, factored with the right inertia, solved for a step.
//
//     [ H + Sigma_x + delta_w I    J'                          ] [ dx      ]       [ r_x             ]
//     [ J                          -(1/S + D + delta_c)        ] [ dlambda ]  =  - [ r_c + r_s/S ]              newton_kkt.md (7),
//
// with r_x = grad f + J' lambda - mu/(x - l) + mu/(u - x), r_s = -lambda - mu/(s - l) + mu/(u - s), S = Sigma_s + delta_w and
// ds = (dlambda - r_s)/S.
#pragma once

#include "tenon/solvers/newton_kkt/barrier_problem.hpp"
#include "tenon/solvers/newton_kkt/inertia.hpp"
#include "tenon/solvers/newton_kkt/inertia_correction.hpp"
#include "tenon/solvers/newton_kkt/kkt_of.hpp"

namespace tenon {

template <NonlinearProgram P, class Kkt>
class NewtonSystem {
 public:
  using Scalar = typename P::Scalar;
  using VectorN = VectorNOf<P>;
  using VectorM = VectorMOf<P>;

  explicit NewtonSystem(const P& problem) : kkt_(make_kkt<Kkt>(problem)) {
    const int n = problem.num_variables(), m = problem.num_constraints();
    for (VectorN* v : {&sigma_x_, &rhs_x_}) v->setZero(n);
    for (VectorM* v : {&give_s_, &d_, &r_s_, &rhs_c_}) v->setZero(m);
    aim_x_.lower.setZero(n), aim_x_.upper.setZero(n);
    aim_s_.lower.setZero(m), aim_s_.upper.setZero(m);
  }

  void reset() {
    correction_.reset();
    delta_w_ = 0;
  }
  Scalar regularization() const { return delta_w_; }

  /// Factors K at `at`, correcting the Hessian until the inertia is (n, m, 0). False where no correction helps.
  bool factor(const BarrierProblem<P>& barrier, const Iterate<P>& at, Scalar mu) {
    if (attempt(barrier, at, 0, 0)) return true;
    // a singular K points at dependent rows: soften them a little before touching the Hessian
    const Scalar delta_c = inertia_.zero > 0 ? Scalar(1e-8) * std::sqrt(std::sqrt(std::max(mu, Scalar(1e-12)))) : Scalar(0);
    if (delta_c > 0 && attempt(barrier, at, 0, delta_c)) return true;
    for (Scalar delta_w = correction_.first(); std::isfinite(delta_w); delta_w = correction_.delta()) {
      if (attempt(barrier, at, delta_w, delta_c)) {
        correction_.accepted(delta_w);
        return true;
      }
      if (!correction_.next()) return false;
    }
    return false;
  }

  /// The Newton step of the barrier problem of this mu, from the last factorisation.
  void step(const BarrierProblem<P>& barrier, const Iterate<P>& at, Scalar mu, Step<P>& step) {
    barrier.x_box().aim_at(mu, aim_x_);
    barrier.s_box().aim_at(mu, aim_s_);
    aimed_step(barrier, at, step);
  }

  /// Mehrotra's corrector: `step` is the affine step and becomes the one that allows for its second-order term.  [Meh92]
  void predicted_step(const BarrierProblem<P>& barrier, const Iterate<P>& at, Scalar mu, Step<P>& step) {
    barrier.x_box().aim_off(mu, step.x.array(), step.zx, aim_x_);
    barrier.s_box().aim_off(mu, step.s.array(), step.zs, aim_s_);
    aimed_step(barrier, at, step);
  }

  /// The last step again with another row residual: a second-order correction.  [WB06, eq. 26]
  void corrected_step(const BarrierProblem<P>& barrier, const Iterate<P>& at, const VectorM& row_residual, Step<P>& step) {
    solve(barrier, at, row_residual, step);
  }

  /// Least-squares multipliers of a cold start: H = I, every row's slack with unit stiffness. False where there are none but 0.
  /// [WB06, sec. 3.6]
  bool least_squares_multipliers(BarrierProblem<P>& barrier, Iterate<P>& at) {
    rhs_x_ = -(barrier.x_box().free_mask() * (barrier.gradient().array() + at.zx.upper - at.zx.lower)).matrix();
    rhs_c_ = -(barrier.s_box().free_mask() * (at.zs.upper - at.zs.lower)).matrix();
    if ((rhs_x_.array() == 0).all() && (rhs_c_.array() == 0).all()) return false;  // nothing to balance
    set_zero(barrier.hessian());
    sigma_x_ = (barrier.x_box().fixed_stiffness() + 1).matrix();
    d_ = barrier.s_box().free_mask().matrix();
    const Inertia inertia = kkt_.factor(barrier.hessian(), barrier.jacobian(), sigma_x_, d_);
    if (inertia.zero > 0) return false;
    kkt_.solve(rhs_x_, rhs_c_, sigma_x_, at.lambda);  // sigma_x_ takes the primal part, which nobody needs
    constexpr Scalar kLargest = 1000;
    return all_finite(at.lambda) && (at.lambda.size() == 0 || at.lambda.template lpNorm<Eigen::Infinity>() <= kLargest);
  }

 private:
  bool attempt(const BarrierProblem<P>& barrier, const Iterate<P>& at, Scalar delta_w, Scalar delta_c) {
    delta_w_ = delta_w;
    barrier.x_box().stiffness(at.zx, sigma_x_.array());
    if (delta_w > 0) sigma_x_.array() += delta_w;
    // 1/Sigma_s: 0 for the fixed slack of an equality, at most 1e30 for a row without bounds
    barrier.s_box().stiffness(at.zs, give_s_.array());
    give_s_.array() = barrier.s_box().free_mask() / (give_s_.array() + delta_w).max(Scalar(1) / Scalar(kFixedStiffness));
    d_ = give_s_ + barrier.compliance();
    if (delta_c > 0) d_.array() += delta_c;
    inertia_ = kkt_.factor(barrier.hessian(), barrier.jacobian(), sigma_x_, d_);
    return inertia_.zero == 0 && inertia_.negative == barrier.m();
  }

  void aimed_step(const BarrierProblem<P>& barrier, const Iterate<P>& at, Step<P>& step) {
    rhs_x_ = -(barrier.x_box().free_mask() * (barrier.stationarity().array() + barrier.x_box().barrier_gradient(aim_x_))).matrix();
    r_s_ = (barrier.s_box().barrier_gradient(aim_s_) - at.lambda.array()).matrix();
    solve(barrier, at, barrier.row_residual(at), step);
  }

  void solve(const BarrierProblem<P>& barrier, const Iterate<P>& at, const auto& row_residual, Step<P>& step) {
    rhs_c_ = -(row_residual + give_s_.cwiseProduct(r_s_));
    kkt_.solve(rhs_x_, rhs_c_, step.x, step.lambda);
    if (barrier.x_box().any_fixed()) step.x.array() *= barrier.x_box().free_mask();
    step.s = give_s_.cwiseProduct(step.lambda - r_s_);
    barrier.x_box().multiplier_step(at.zx, step.x.array(), aim_x_, step.zx);
    barrier.s_box().multiplier_step(at.zs, step.s.array(), aim_s_, step.zs);
  }

  Kkt kkt_;
  InertiaCorrection<Scalar> correction_;
  Inertia inertia_;
  Scalar delta_w_ = 0;
  BoxSides<Scalar, P::kVariables> aim_x_;
  BoxSides<Scalar, P::kConstraints> aim_s_;
  VectorN sigma_x_, rhs_x_;
  VectorM give_s_, d_, r_s_, rhs_c_;
};

}  // namespace tenon
