// The barrier problem: the user's problem with a slack for each row and a logarithmic wall at each bound.
//
//     min  phi = f(x) + sum of e (e/(2 D) + preload) - mu sum of log(distances)     s.t.  r_c = c(x) - s - e = 0
//
// It owns the evaluations at the current iterate and knows every residual; it knows no step and no linear algebra.
#pragma once

#include <algorithm>
#include <cmath>

#include "tenon/core/point.hpp"
#include "tenon/solvers/newton_kkt/iterate.hpp"
#include "tenon/solvers/newton_kkt/transposed_product.hpp"

namespace tenon {

template <class Scalar>
struct BarrierError {
  Scalar stationarity = 0;     // |grad f + J' lambda + z_u - z_l|_inf, slacks' stationarity included
  Scalar primal = 0;           // |c(x) - s - e|_inf
  Scalar complementarity = 0;  // max |product - mu|
  Scalar scale = 1;            // s_d of [WB06, eq. 6]

  Scalar max_scaled() const { return std::max({stationarity / scale, primal, complementarity / scale}); }
};

/// How far x, s and lambda go, and how far the bound multipliers.
template <class Scalar>
struct StepLengths {
  Scalar primal = 0, dual = 0;

  Scalar min() const { return std::min(primal, dual); }
};

template <NonlinearProgram P>
class BarrierProblem {
 public:
  using Scalar = typename P::Scalar;
  using VectorN = VectorNOf<P>;
  using VectorM = VectorMOf<P>;

  explicit BarrierProblem(const P& problem)
      : problem_(problem),
        n_(problem.num_variables()),
        m_(problem.num_constraints()),
        workspace_(problem.make_workspace()),
        bounds_(n_, m_),
        x_box_(n_),
        s_box_(m_),
        jacobian_(zero_jacobian(problem)),
        transposed_product_(product_of(problem)),
        hessian_(zero_hessian(problem)) {
    gradient_.setZero(n_);
    stationarity_.setZero(n_);
    compliance_.setZero(m_);
  }

  int n() const { return n_; }
  int m() const { return m_; }
  const BoundsOf<P>& bounds() const { return bounds_; }
  const BarrierBox<Scalar, P::kVariables>& x_box() const { return x_box_; }
  const BarrierBox<Scalar, P::kConstraints>& s_box() const { return s_box_; }
  int sides() const { return x_box_.sides() + s_box_.sides(); }

  const VectorN& gradient() const { return gradient_; }
  const JacobianOf<P>& jacobian() const { return jacobian_; }
  const HessianOf<P>& hessian() const { return hessian_; }
  HessianOf<P>& hessian() { return hessian_; }

  /// grad f + J' lambda, of the last linearise().
  const VectorN& stationarity() const { return stationarity_; }

  /// Takes the problem's bounds of this moment; moves fixed variables and slacks to their values.
  void take_bounds(Iterate<P>& at) {
    bounds_.remove_limits();
    problem_.bounds(bounds_);
    x_box_.set(bounds_.x_lower, bounds_.x_upper, at.x);
    s_box_.set(bounds_.c_lower, bounds_.c_upper, at.s);
    compliance_ = bounds_.compliance;
    compliant_ = (bounds_.compliance.array() > 0).any();
    all_compliant_ = m_ > 0 && (bounds_.compliance.array() > 0).all();
  }

  /// Compliant rows are softer while mu is large: a row that the bounds do not let be met then pulls no harder than the barrier pushes, and
  /// both sharpen together.  newton_kkt.md (13)
  void soften_rows(Scalar mu) {
    if (!compliant_) return;
    compliance_ = bounds_.compliance * std::max(Scalar(1), std::min(mu * kSoftness, Scalar(1)) / bounds_.compliance.maxCoeff());
  }
  /// Whether rows have the compliance that was asked for.
  bool rows_are_firm() const { return compliance_ == bounds_.compliance; }
  const VectorM& compliance() const { return compliance_; }

  /// f and c at at.x. False where a value is not finite.
  bool evaluate(Iterate<P>& at) {
    problem_.prepare(at.x, workspace_);
    at.objective = problem_.objective(at.x, workspace_);
    problem_.constraints(at.x, workspace_, at.constraints);
    return std::isfinite(at.objective) && all_finite(at.constraints);
  }

  /// Brings the shared workspace back to `at` after trial points elsewhere.
  void return_to(const Iterate<P>& at) { problem_.prepare(at.x, workspace_); }

  /// Gradient, Jacobian, grad f + J' lambda and the boxes at `at`, where evaluate() was last called. False where a value is not finite.
  bool linearise(const Iterate<P>& at) {
    x_box_.stand_at(at.x.array());
    s_box_.stand_at(at.s.array());
    problem_.gradient(at.x, workspace_, gradient_);
    problem_.jacobian(at.x, workspace_, values_of(jacobian_));
    update_stationarity(at);
    return all_finite(stationarity_);
  }

  void update_stationarity(const Iterate<P>& at) {
    stationarity_ = gradient_;
    if constexpr (kFixedSize<P>) stationarity_.noalias() += jacobian_.transpose() * at.lambda;
    else transposed_product_.add(jacobian_, at.lambda, stationarity_);
  }

  void evaluate_hessian(const Iterate<P>& at) { problem_.hessian(at.x, Scalar(1), at.lambda, workspace_, values_of(hessian_)); }

  /// r_c = c(x) - s - D (lambda - preload), as an expression: it refers to `at`.
  auto row_residual(const Iterate<P>& at) const {
    return at.constraints - at.s - compliance_.cwiseProduct(at.lambda - bounds_.preload);
  }

  bool all_rows_compliant() const { return all_compliant_; }

  /// lambda such that every row is met: e = c - s.
  void let_rows_give_way(Iterate<P>& at) const {
    at.lambda = bounds_.preload + (at.constraints - at.s).cwiseQuotient(compliance_);
  }

  /// Derivative of phi along (dx, ds) where the rows keep giving way: grad f' dx + lambda' (J dx - ds) + barrier.
  Scalar give_way_slope(const Iterate<P>& at, const Step<P>& step, Scalar mu) const {
    return gradient_.dot(step.x) + (jacobian_ * step.x - step.s).dot(at.lambda) + logarithms_slope(step, mu);
  }

  /// theta = |r_c|_1
  Scalar violation(const Iterate<P>& at) const { return row_residual(at).template lpNorm<1>(); }

  /// Largest |c - s| of the rows that cannot give way.
  Scalar hard_violation(const Iterate<P>& at) const {
    if (m_ == 0) return 0;
    return (bounds_.compliance.array() == 0).select((at.constraints - at.s).array().abs(), Scalar(0)).maxCoeff();
  }

  /// phi of `at` for this mu.
  Scalar barrier_objective(const Iterate<P>& at, Scalar mu) const {
    Scalar phi = at.objective;
    if (compliant_) {
      const auto lean = at.lambda.array() - bounds_.preload.array();  // e = D lean
      phi += (compliance_.array() * lean * (lean / 2 + bounds_.preload.array())).sum();
    }
    if (sides() > 0) phi -= mu * (x_box_.log_barrier(at.x.array()) + s_box_.log_barrier(at.s.array()));
    return phi;
  }

  /// Derivative of phi along the step, at the linearised iterate.
  Scalar barrier_slope(const Iterate<P>& at, const Step<P>& step, Scalar mu) const {
    Scalar slope = gradient_.dot(step.x);
    if (compliant_) slope += (compliance_.array() * at.lambda.array() * step.lambda.array()).sum();
    return slope + logarithms_slope(step, mu);
  }

  /// How far the linearised iterate is from solving the barrier problem of this mu (mu = 0: the problem itself).
  BarrierError<Scalar> error(const Iterate<P>& at, Scalar mu) const {
    BarrierError<Scalar> out;
    const auto &free_x = x_box_.free_mask(), &free_s = s_box_.free_mask();
    out.stationarity = (free_x * (stationarity_.array() + at.zx.upper - at.zx.lower)).abs().maxCoeff();
    Scalar multipliers = 0;
    if (m_ > 0) {
      out.stationarity = std::max(out.stationarity, (free_s * (at.zs.upper - at.zs.lower - at.lambda.array())).abs().maxCoeff());
      out.primal = row_residual(at).template lpNorm<Eigen::Infinity>();
      multipliers = at.lambda.template lpNorm<1>();
    }
    if (sides() > 0) {
      multipliers += (at.zx.upper + at.zx.lower).sum();
      out.complementarity =
          std::max(x_box_.complementarity(at.zx, mu), s_box_.complementarity(at.zs, mu));
    }
    constexpr Scalar kMultiplierScale = 100;
    out.scale = std::max(kMultiplierScale, multipliers / Scalar(std::max(1, n_ + m_))) / kMultiplierScale;
    return out;
  }

  /// Mean product of multipliers and distances at the linearised iterate; 0 without bounds.
  Scalar mean_complementarity(const Iterate<P>& at) const {
    if (sides() == 0) return 0;
    return (x_box_.sum_of_products(at.zx) + s_box_.sum_of_products(at.zs)) / Scalar(sides());
  }

  /// The same after a step of these lengths.
  Scalar mean_complementarity_after(const Iterate<P>& at, const Step<P>& step, StepLengths<Scalar> alpha) const {
    return (x_box_.sum_of_products_after(at.zx, step.x.array(), alpha.primal, step.zx, alpha.dual) +
            s_box_.sum_of_products_after(at.zs, step.s.array(), alpha.primal, step.zs, alpha.dual)) / Scalar(sides());
  }

  /// Fraction to the boundary, from the linearised iterate.
  Scalar max_primal_step(const Step<P>& step, Scalar tau) const {
    return std::min(x_box_.max_step(step.x.array(), tau), s_box_.max_step(step.s.array(), tau));
  }
  Scalar max_dual_step(const Iterate<P>& at, const Step<P>& step, Scalar tau) const {
    return std::min(x_box_.max_multiplier_step(at.zx, step.zx, tau), s_box_.max_multiplier_step(at.zs, step.zs, tau));
  }
  StepLengths<Scalar> max_steps(const Iterate<P>& at, const Step<P>& step, Scalar tau) const {
    return {max_primal_step(step, tau), max_dual_step(at, step, tau)};
  }

  /// Multipliers on the central path of mu.
  void centre(Scalar mu, Iterate<P>& at) const {
    x_box_.centre(mu, at.zx);
    s_box_.centre(mu, at.zs);
  }

 private:
  static constexpr Scalar kSoftness = 1000;

  Scalar logarithms_slope(const Step<P>& step, Scalar mu) const {
    return x_box_.barrier_slope(step.x.array(), mu) + s_box_.barrier_slope(step.s.array(), mu);
  }

  static JacobianOf<P> zero_jacobian(const P& problem) {
    if constexpr (kFixedSize<P>) return JacobianOf<P>::Zero();
    else return problem.jacobian_pattern().zero_matrix();
  }
  struct Nothing {};
  using Product = std::conditional_t<kFixedSize<P>, Nothing, TransposedProduct>;
  static Product product_of(const P& problem) {
    if constexpr (kFixedSize<P>) return {};
    else return TransposedProduct(problem.jacobian_pattern());
  }
  static HessianOf<P> zero_hessian(const P& problem) {
    if constexpr (kFixedSize<P>) return HessianOf<P>{};
    else return problem.hessian_pattern().zero_matrix();
  }

  const P& problem_;
  int n_, m_;
  WorkspaceOf<P> workspace_;
  BoundsOf<P> bounds_;
  BarrierBox<Scalar, P::kVariables> x_box_;
  BarrierBox<Scalar, P::kConstraints> s_box_;
  VectorM compliance_;
  bool compliant_ = false, all_compliant_ = false;
  VectorN gradient_, stationarity_;
  JacobianOf<P> jacobian_;
  Product transposed_product_;  // of sparse Jacobians
  HessianOf<P> hessian_;
};

}  // namespace tenon
