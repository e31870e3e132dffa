// Filter line search: shortens the step until the new point improves the violation theta or the barrier objective phi enough, against the
// current point and against the filter; tries second-order corrections where a full step makes the violation worse.  [WB06, sec. 2.3, 2.4]
#pragma once

#include "tenon/solvers/newton_kkt/filter.hpp"
#include "tenon/solvers/newton_kkt/newton_system.hpp"

namespace tenon {

template <NonlinearProgram P, class Kkt>
class FilterLineSearch {
 public:
  using Scalar = typename P::Scalar;

  FilterLineSearch(int n, int m) : corrected_(n, m) { soc_residual_.setZero(m); }

  /// Forgets the filter: the barrier objective has changed. theta_max and theta_min follow the first violation of the solve.
  void reset() { filter_.clear(); }
  void start(Scalar theta) {
    filter_.clear();
    trials_ = 0;
    theta_max_ = Scalar(1e4) * std::max(Scalar(1), theta);
    theta_min_ = Scalar(1e-4) * std::max(Scalar(1), theta);
  }

  /// For restoration: leave the present point for good; may a point be where it is?
  void forbid(Scalar theta, Scalar phi) { filter_.add(theta, phi); }
  bool allows(Scalar theta, Scalar phi) const { return std::isfinite(phi) && filter_.accepts(theta, phi); }

  int trials() const { return trials_; }
  Scalar alpha() const { return alpha_; }

  /// Whether the last step taken is a second-order correction, whose multiplier steps are its own.
  bool corrected() const { return corrected_last_; }

  /// Whether the step at full length alpha_max leads to an acceptable `trial`.
  bool try_full(BarrierProblem<P>& barrier, const Iterate<P>& now, const Step<P>& step, Scalar alpha_max, Scalar alpha_dual, Scalar mu,
                Iterate<P>& trial) {
    theta_ = barrier.violation(now);
    phi_ = barrier.barrier_objective(now, mu);
    slope_ = barrier.barrier_slope(now, step, mu);
    trials_ = 0;
    corrected_last_ = false;
    alpha_ = alpha_max;
    if (try_point(barrier, now, step, mu, trial)) return true;
    return trial_finite_ && error_falls(barrier, now, step, alpha_dual, mu, trial);
  }

  /// Looks for an acceptable `trial` = now + alpha step, alpha <= alpha_max; `step` becomes the one taken, and `barrier` is linearised there.
  /// False where there is none.
  bool search(BarrierProblem<P>& barrier, NewtonSystem<P, Kkt>& system, const Iterate<P>& now, Step<P>& step, Scalar alpha_max,
              Scalar alpha_dual, Scalar tau, Scalar mu, Iterate<P>& trial) {
    if (try_full(barrier, now, step, alpha_max, alpha_dual, mu, trial)) return true;
    if (trial_finite_ && trial_theta_ >= theta_ && correct(barrier, system, now, step, tau, mu, trial)) return true;
    const Scalar alpha_min = smallest_step();
    while ((alpha_ /= 2) >= alpha_min) {
      if (try_point(barrier, now, step, mu, trial)) return true;
    }
    return barrier.all_rows_compliant() && give_way(barrier, now, step, alpha_max, mu, trial);
  }

 private:
  static constexpr Scalar kGammaTheta = Filter<Scalar>::kGammaTheta, kGammaPhi = Filter<Scalar>::kGammaPhi, kEtaPhi = Scalar(1e-8), kDelta = 1;
  static constexpr Scalar kGammaAlpha = Scalar(0.05), kKappaSoc = Scalar(0.99);
  static constexpr Scalar kErrorFall = Scalar(0.9), kNearSolution = Scalar(1e-2);
  static constexpr int kMaxCorrections = 4;

  void move(const BarrierProblem<P>& barrier, const Iterate<P>& now, const Step<P>& step, Iterate<P>& trial) const {
    trial.x = now.x + alpha_ * step.x;
    trial.s = now.s + alpha_ * step.s;
    barrier.x_box().keep_inside(trial.x.array());
    barrier.s_box().keep_inside(trial.s.array());
  }

  /// now + alpha step, evaluated and judged.
  bool try_point(BarrierProblem<P>& barrier, const Iterate<P>& now, const Step<P>& step, Scalar mu, Iterate<P>& trial) {
    ++trials_;
    move(barrier, now, step, trial);
    trial.lambda = now.lambda + alpha_ * step.lambda;
    trial_finite_ = barrier.evaluate(trial);
    if (!trial_finite_) return false;
    trial_theta_ = barrier.violation(trial);
    return acceptable(trial_theta_, barrier.barrier_objective(trial, mu)) && has_derivatives(barrier, now, trial);
  }

  /// An iterate needs derivatives: a point without them is one where the problem cannot be evaluated.
  bool has_derivatives(BarrierProblem<P>& barrier, const Iterate<P>& now, const Iterate<P>& trial) {
    if (barrier.linearise(trial)) return true;
    come_back(barrier, now);
    return false;
  }

  static void come_back(BarrierProblem<P>& barrier, const Iterate<P>& now) {
    barrier.return_to(now);
    barrier.linearise(now);
  }

  /// Newton's own measure: a full step that brings the primal-dual error down is a good one, even where the barrier objective, which rounding
  /// spoils near the solution, does not see it.
  bool error_falls(BarrierProblem<P>& barrier, const Iterate<P>& now, const Step<P>& step, Scalar alpha_dual, Scalar mu,
                   Iterate<P>& trial) {
    const Scalar error = barrier.error(now, mu).max_scaled();
    if (!(error < kNearSolution)) return false;
    take_dual_step(now, step, alpha_dual, trial);
    if (barrier.linearise(trial) && barrier.error(trial, mu).max_scaled() <= kErrorFall * error) return true;
    come_back(barrier, now);
    return false;
  }

  /// [WB06, eq. 18-20, with the rounding of phi allowed for]
  bool acceptable(Scalar theta, Scalar phi) {
    if (!std::isfinite(phi) || theta > theta_max_ || !filter_.accepts(theta, phi)) return false;
    const Scalar rounding = 10 * std::numeric_limits<Scalar>::epsilon() * std::abs(phi_);
    if (theta_ <= theta_min_ && switching()) return phi <= phi_ + kEtaPhi * alpha_ * slope_ + rounding;
    if (theta <= (1 - kGammaTheta) * theta_ || phi <= phi_ - kGammaPhi * theta_ + rounding) {
      filter_.add(theta_, phi_);
      return true;
    }
    return false;
  }

  /// The step promises more descent than its violation is worth.
  bool switching() const {
    return slope_ < 0 && alpha_ * slope_power() > kDelta * theta_power();
  }

  // theta^s_theta and (-slope)^s_phi with s_theta = 9/8 and s_phi = 5/2 > 2 s_theta: square roots cost less than powers
  Scalar theta_power() const { return theta_ * std::sqrt(std::sqrt(std::sqrt(theta_))); }
  Scalar slope_power() const { return slope_ * slope_ * std::sqrt(-slope_); }

  /// [WB06, eq. 23]
  Scalar smallest_step() const {
    Scalar smallest = kGammaTheta;
    if (slope_ < 0) {
      smallest = std::min(smallest, kGammaPhi * theta_ / -slope_);
      if (theta_ <= theta_min_) smallest = std::min(smallest, kDelta * theta_power() / slope_power());
    }
    return std::max(kGammaAlpha * smallest, Scalar(1e-14));
  }

  /// Second-order corrections: the row residual gathers what the full step left.  [WB06, algorithm A, steps]
  bool correct(BarrierProblem<P>& barrier, NewtonSystem<P, Kkt>& system, const Iterate<P>& now, Step<P>& step, Scalar tau, Scalar mu,
               Iterate<P>& trial) {
    const Scalar alpha_full = alpha_;
    Scalar theta_before = theta_;
    soc_residual_ = alpha_ * barrier.row_residual(now) + barrier.row_residual(trial);
    for (int k = 0; k < kMaxCorrections; ++k) {
      system.corrected_step(barrier, now, soc_residual_, corrected_);
      alpha_ = barrier.max_primal_step(corrected_, tau);
      if (try_point(barrier, now, corrected_, mu, trial)) {
        std::swap(step, corrected_);
        corrected_last_ = true;
        return true;
      }
      if (!trial_finite_ || trial_theta_ > kKappaSoc * theta_before) break;
      theta_before = trial_theta_;
      soc_residual_ = alpha_ * soc_residual_ + barrier.row_residual(trial);
    }
    alpha_ = alpha_full;
    return false;
  }

  /// Where every row is compliant, letting all of them give way (e = c - s) makes any point feasible, and the Newton step is a descent
  /// direction of phi taken there, whatever lambda was: the search that cannot fail for want of feasibility.  newton_kkt.md (12)
  bool give_way(BarrierProblem<P>& barrier, const Iterate<P>& now, const Step<P>& step, Scalar alpha_max, Scalar mu, Iterate<P>& trial) {
    trial = now;
    barrier.let_rows_give_way(trial);
    const Scalar phi = barrier.barrier_objective(trial, mu);
    const Scalar slope = barrier.give_way_slope(trial, step, mu);
    if (!(slope < 0)) return false;
    const Scalar rounding = 10 * std::numeric_limits<Scalar>::epsilon() * std::abs(phi);
    for (alpha_ = alpha_max; alpha_ >= alpha_max * Scalar(1e-10); alpha_ /= 2) {
      ++trials_;
      move(barrier, now, step, trial);
      if (!barrier.evaluate(trial)) continue;
      barrier.let_rows_give_way(trial);
      if (barrier.barrier_objective(trial, mu) <= phi + Scalar(1e-4) * alpha_ * slope + rounding && has_derivatives(barrier, now, trial)) {
        filter_.clear();
        return true;
      }
    }
    return false;
  }

  Filter<Scalar> filter_;
  Scalar theta_max_ = 0, theta_min_ = 0;
  Scalar theta_ = 0, phi_ = 0, slope_ = 0;  // of the current iterate
  Scalar alpha_ = 0, trial_theta_ = 0;
  bool trial_finite_ = false, corrected_last_ = false;
  int trials_ = 0;
  Step<P> corrected_;
  VectorMOf<P> soc_residual_;
};

}  // namespace tenon
