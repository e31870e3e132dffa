// Newton-KKT: a primal-dual interior-point method with a filter line search. One template for small problems of fixed size (no allocation,
// no virtual call) and for every `Nlp` (sparse); the linear algebra is an object (kkt_of.hpp). Derivation: newton_kkt.md.
//
// [WB06] A. Waechter, L. T. Biegler, On the implementation of an interior-point filter line-search algorithm for large-scale nonlinear
//        programming, Mathematical Programming 106 (2006).
#pragma once

#include <chrono>
#include <optional>
#include <type_traits>
#include <utility>

#include "tenon/core/options.hpp"
#include "tenon/core/result.hpp"
#include "tenon/solvers/newton_kkt/barrier_parameter.hpp"
#include "tenon/solvers/newton_kkt/filter_line_search.hpp"
#include "tenon/solvers/newton_kkt/starts.hpp"

namespace tenon {

template <NonlinearProgram P, class Kkt = KktOf<P>>
class Restoration;

/// In the place of Restoration: where the line search finds nothing, the solve ends.
struct NoRestoration {
  template <class P>
  NoRestoration(const P&, const Options&) {}
};

/// In the place of a clock, where the caller holds one: elapsed is 0 and no time limit applies.
struct NoClock {
  using time_point = std::chrono::steady_clock::time_point;
  static time_point now() { return {}; }
};

template <NonlinearProgram P, class Kkt = KktOf<P>, class Rescue = Restoration<P, Kkt>, class Clock = std::chrono::steady_clock>
class NewtonKkt {
 public:
  using Scalar = typename P::Scalar;

  /// Allocates all that a solve needs. The problem must outlive this; its bounds are asked for at every solve.
  explicit NewtonKkt(const P& problem, Options options = {})
      : options_(std::move(options)),
        barrier_(problem),
        system_(problem),
        restoration_(problem, options_),
        line_search_(barrier_.n(), barrier_.m()),
        iterates_{Iterate<P>(barrier_.n(), barrier_.m()), Iterate<P>(barrier_.n(), barrier_.m())},
        step_(barrier_.n(), barrier_.m()) {}
  NewtonKkt(const NewtonKkt&) = delete;
  NewtonKkt& operator=(const NewtonKkt&) = delete;

  /// Starts from `point`, ends in it. Allocates nothing, throws nothing.
  Result solve(PointOf<P>& point) {
    return solve(point, [](const Iterate<P>&) { return false; });
  }

  /// The same; `enough(iterate)` ends it with Status::stopped.
  template <class Enough>
  Result solve(PointOf<P>& point, Enough&& enough) {
    begin_ = Clock::now();
    std::optional<Status> ended = start(point);
    while (!ended) {
      measure();
      if ((ended = stop())) break;
      if (enough(std::as_const(*now_))) {
        ended = Status::stopped;
        break;
      }
      update_barrier();
      if (!factor()) {
        if ((ended = restore())) break;
        continue;
      }
      compute_step();
      if (warm_start_hits_a_wall()) {
        start_again_from_inside();
        continue;
      }
      if (search()) accept();
      else if ((ended = restore())) break;
    }
    return finish(point, *ended);
  }

  Options& options() { return options_; }

  /// c(x) at the point that the last solve returned.
  const VectorMOf<P>& constraints() const { return now_->constraints; }

 private:
  using VectorN = VectorNOf<P>;

  std::optional<Status> start(PointOf<P>& point) {
    now_->x = point.x;
    now_->lambda = point.lambda;
    iterations_ = tiny_steps_ = creeping_steps_ = 0;
    trust_guess_ = options_.warm_start;
    alpha_ = {};
    system_.reset();
    barrier_.take_bounds(*now_);

    const bool warm = options_.warm_start;
    if (!begin_inside(barrier_, warm ? kWarmPush<Scalar> : kColdPush<Scalar>, *now_)) return Status::invalid_start;
    if (warm) begin_warm(point);
    else begin_cold();
    if (barrier_.sides() == 0) mu_.switch_off();
    barrier_.soften_rows(mu_.at_end() ? 0 : mu_.value());
    line_search_.start(barrier_.violation(*now_));
    return std::nullopt;
  }

  void begin_cold() {
    mu_.start(options_.initial_mu > 0 ? Scalar(options_.initial_mu) : BarrierParameter<Scalar>::kInitial, tolerance());
    cold_multipliers(barrier_, system_, *now_);
  }

  void begin_warm(const PointOf<P>& point) {
    mu_.start(Scalar(options_.initial_mu), tolerance());
    warm_multipliers(barrier_, point, mu_.value(), *now_);
    if (options_.initial_mu == 0) mu_.start(std::min(barrier_.mean_complementarity(*now_), BarrierParameter<Scalar>::kInitial), tolerance());
  }

  void measure() {
    error_ = barrier_.error(*now_, 0);
    const bool creeps = error_.scale > kRunaway && error_.primal <= tolerance() &&
                        std::abs(now_->objective - last_objective_) <= kCreep * (1 + std::abs(last_objective_));
    creeping_steps_ = creeps ? creeping_steps_ + 1 : 0;
    last_objective_ = now_->objective;
    if (options_.on_iteration) stopped_ = !options_.on_iteration(describe());
  }

  std::optional<Status> stop() {
    if (error_.max_scaled() <= tolerance() && iterations_ >= options_.min_iterations && barrier_.rows_are_firm()) return Status::solved;
    if (options_.on_iteration && stopped_) return Status::stopped;
    if (iterations_ >= options_.max_iterations) return Status::iteration_limit;
    if (std::isfinite(options_.time_limit) && elapsed() >= options_.time_limit) return Status::time_limit;
    if (tiny_steps_ >= 2 && mu_.at_end()) return no_progress();
    if (creeping_steps_ >= kPatience) return no_progress();  // multipliers that grow without limit: there are none to converge to
    if (now_->objective < -kDivergence && error_.primal <= tolerance()) return Status::unbounded;
    if (now_->x.template lpNorm<Eigen::Infinity>() > kDivergence) return Status::unbounded;
    return std::nullopt;
  }

  /// In free gait mu waits for the step. In monotone gait: the next barrier problem, as soon as this one is solved well enough; several at
  /// once where the iterate allows it.
  void update_barrier() {
    if (barrier_.sides() == 0) return;
    const bool cramped = tiny_steps_ > 0 || (iterations_ > 0 && alpha_.primal < kCramped);
    const bool falls = !cramped && !(mu_.at_end() && !mu_.is_free()) && mu_.falls(error_.max_scaled());
    if (mu_.is_free()) {
      if (!falls) mu_.go_monotone(barrier_.mean_complementarity(*now_));
      new_barrier_problem();
      return;
    }
    if (falls) {
      mu_.go_free();
      return;
    }
    while (!mu_.at_end() && (mu_.solved(barrier_.error(*now_, mu_.value()).max_scaled()) || tiny_steps_ > 0)) {
      mu_.decrease();
      new_barrier_problem();
    }
  }

  void new_barrier_problem() {
    barrier_.soften_rows(mu_.at_end() ? 0 : mu_.value());
    line_search_.reset();
    tiny_steps_ = 0;
  }

  bool factor() {
    barrier_.evaluate_hessian(*now_);
    return system_.factor(barrier_, *now_, mu_.value());
  }

  void compute_step() {
    predicted_ = mu_.is_free() && predict_step();
    if (!predicted_) system_.step(barrier_, *now_, mu_.value(), step_);
    alpha_ = barrier_.max_steps(*now_, step_, mu_.tau());
  }

  /// Free gait: mu from the affine step. Where that one goes far and the Hessian needed no help, the step that allows for its second-order
  /// term is worth taking: true, with the step.
  bool predict_step() {
    const Scalar gap = barrier_.mean_complementarity(*now_);
    if (mu_.has_arrived(gap)) {
      mu_.choose_smallest();
      return false;
    }
    system_.step(barrier_, *now_, 0, step_);
    const StepLengths<Scalar> affine = barrier_.max_steps(*now_, step_, 1);
    mu_.choose(gap, barrier_.mean_complementarity_after(*now_, step_, affine),
               barrier_.all_rows_compliant() ? 0 : mu_.tether(error_.primal, error_.max_scaled()));
    if (affine.min() < kFar || system_.regularization() > 0) return false;
    system_.predicted_step(barrier_, *now_, mu_.value(), step_);
    return true;
  }

  /// A warm start has a small mu and a guess of the active bounds. Where a bound that it did not guess cuts the step short, the iterates would
  /// creep along the walls: better to begin again, from this point moved inside, with a barrier worth the name.
  bool warm_start_hits_a_wall() const {
    return trust_guess_ && alpha_.min() < kWall && mu_.value() < kRecentre;
  }

  void start_again_from_inside() {
    trust_guess_ = false;
    ++iterations_;
    mu_.start(kRecentre, tolerance());
    new_barrier_problem();
    recentre(barrier_, mu_.value(), *now_, *trial_);
    line_search_.start(barrier_.violation(*now_));
  }

  /// A predicted step need not be one of descent: it is taken at full length or not at all.
  bool search() {
    if (!all_finite(step_.x) || !all_finite(step_.lambda)) return false;
    if (predicted_) {
      if (line_search_.try_full(barrier_, *now_, step_, alpha_.primal, alpha_.dual, mu_.value(), *trial_)) return true;
      system_.step(barrier_, *now_, mu_.value(), step_);
      alpha_ = barrier_.max_steps(*now_, step_, mu_.tau());
    }
    return line_search_.search(barrier_, system_, *now_, step_, alpha_.primal, alpha_.dual, mu_.tau(), mu_.value(), *trial_);
  }

  /// No acceptable step from here: a point with less violation, or the end.
  std::optional<Status> restore() {
    barrier_.return_to(*now_);
    if constexpr (std::is_same_v<Rescue, NoRestoration>) {
      return no_progress();
    } else {
      const Scalar theta = barrier_.hard_violation(*now_);
      if (theta <= tolerance()) return no_progress();
      line_search_.forbid(barrier_.violation(*now_), barrier_.barrier_objective(*now_, mu_.value()));
      trial_->lambda = now_->lambda;
      const auto violation = [&](const VectorN& x) {
        trial_->x = x;
        if (!barrier_.evaluate(*trial_)) return kInfinity<Scalar>;
        follow_rows(barrier_, kColdPush<Scalar>, *trial_);
        return barrier_.hard_violation(*trial_);
      };
      const auto good_enough = [&](const VectorN& x) {
        return violation(x) <= kRestored * theta &&
               line_search_.allows(barrier_.violation(*trial_), barrier_.barrier_objective(*trial_, mu_.value()));
      };
      const double time_left = options_.time_limit - (std::isfinite(options_.time_limit) ? elapsed() : 0.0);
      const auto ended = restoration_.restore(now_->x, std::max(mu_.value(), theta), options_.max_iterations - iterations_, time_left,
                                              violation, good_enough);
      iterations_ += 1 + restoration_.iterations();
      if (ended && *ended != Status::infeasible) {  // the last accepted iterate stands
        barrier_.evaluate(*now_);
        barrier_.linearise(*now_);
        return ended;
      }
      if (!begin_at_restored(barrier_, system_, restoration_.x(), mu_.value(), *now_)) return Status::numerical_failure;
      return ended;
    }
  }

  void accept() {
    alpha_.primal = line_search_.alpha();
    if (line_search_.corrected()) alpha_.dual = barrier_.max_dual_step(*now_, step_, mu_.tau());
    const Scalar largest = (step_.x.array().abs() / (1 + now_->x.array().abs())).maxCoeff() * alpha_.primal;
    tiny_steps_ = largest < 10 * std::numeric_limits<Scalar>::epsilon() ? tiny_steps_ + 1 : 0;

    take_dual_step(*now_, step_, alpha_.dual, *trial_);
    barrier_.x_box().safeguard(mu_.value(), trial_->zx);
    barrier_.s_box().safeguard(mu_.value(), trial_->zs);
    std::swap(now_, trial_);
    ++iterations_;
  }

  /// No acceptable step is left: good enough, or a failure.
  Status no_progress() const {
    return error_.max_scaled() <= kAcceptableFactor * tolerance() && barrier_.rows_are_firm() ? Status::acceptable : Status::numerical_failure;
  }

  Result finish(PointOf<P>& point, Status status) {
    point.x = now_->x;
    point.lambda = now_->lambda;
    const auto& box = barrier_.x_box();
    // a fixed variable has the multiplier that balances its stationarity
    point.z = (box.free_mask() > 0).select(now_->zx.upper - now_->zx.lower, -barrier_.stationarity().array());
    Result result;
    result.status = status;
    result.iterations = iterations_;
    result.objective = double(now_->objective);
    step_.x = barrier_.stationarity() + point.z;  // the step is done with: its storage serves the ruler
    step_.s = now_->constraints - barrier_.bounds().compliance.cwiseProduct(point.lambda - barrier_.bounds().preload);
    result.residual = kkt_residual(point, barrier_.bounds(), step_.x, step_.s);
    if (status == Status::invalid_start) {  // what the ruler read was never written
      point.z.setZero();
      result.residual.stationarity = result.residual.complementarity = kInfinity<double>;
    }
    result.elapsed = elapsed();
    return result;
  }

  Iteration describe() const {
    return {iterations_, double(now_->objective), double(error_.primal), double(error_.stationarity), double(error_.complementarity),
            double(mu_.value()), double(alpha_.primal), double(alpha_.dual), double(system_.regularization()), line_search_.trials()};
  }

  Scalar tolerance() const { return Scalar(options_.tolerance); }
  double elapsed() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }

  static constexpr Scalar kWall = Scalar(0.3), kRecentre = Scalar(1e-3);
  static constexpr Scalar kCramped = Scalar(1e-3);
  static constexpr Scalar kFar = Scalar(0.1);
  static constexpr Scalar kDivergence = Scalar(1e20);
  static constexpr Scalar kRunaway = Scalar(1e6), kCreep = Scalar(1e-6);
  static constexpr int kPatience = 10;
  static constexpr Scalar kRestored = Scalar(0.9);   // kappa_resto of [WB06, sec. 3.3]

  Options options_;
  BarrierProblem<P> barrier_;
  NewtonSystem<P, Kkt> system_;
  Rescue restoration_;
  FilterLineSearch<P, Kkt> line_search_;
  BarrierParameter<Scalar> mu_;
  Iterate<P> iterates_[2];
  Iterate<P>* now_ = &iterates_[0];  // the two change places when a step is accepted
  Iterate<P>* trial_ = &iterates_[1];
  Step<P> step_;
  BarrierError<Scalar> error_;
  StepLengths<Scalar> alpha_;
  Scalar last_objective_ = 0;
  typename Clock::time_point begin_;
  int iterations_ = 0, tiny_steps_ = 0, creeping_steps_ = 0;
  bool stopped_ = false, trust_guess_ = false, predicted_ = false;
};

}  // namespace tenon

#include "tenon/solvers/newton_kkt/restoration.hpp"
