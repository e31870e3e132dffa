// One control tick after the other on a solver of the caller's choice: linear solution, start, solve, judge, and what to do when it fails.
//
//     hard limits   rows with a large stiffness, preloaded by the multipliers of the linear solution: what can be had is met, what cannot be
//                   had within the limits is missed by the least weighted error, in one and the same solve
//     soft limits   the notes' problem with hard rows, started from the tick before
//
// The arms are led along the branch of the linear solution (the global optimum of linear maps) by a first-order lag, so that they neither
// stay on a wrong branch after a singular direction nor chase noise: a_branch = a_prev + clip(gain (a_linear - a_prev)).
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "tenon/core/options.hpp"
#include "tenon/core/point.hpp"
#include "tenon/core/result.hpp"
#include "tenon/problems/allocation/allocator.hpp"
#include "tenon/problems/allocation/linear_allocation.hpp"
#include "tenon/problems/allocation/tick_predictor.hpp"
#include "tenon/problems/allocation/wrench_allocation.hpp"

namespace tenon {

/// SolverType: built from (const WrenchAllocation<N>&, const Options&), with `Result solve(PointOf<WrenchAllocation<N>>&)` and
/// `constraints()`, the rows at the point it returned.
template <int N, class SolverType>
class TickAllocator final : public Allocator {
 public:
  using Problem = WrenchAllocation<N>;
  using Lanes = typename Problem::Lanes;

  /// Throws std::invalid_argument where the vehicle has not N rotors.
  TickAllocator(const Vehicle& vehicle, const Options& options)
      : TickAllocator(vehicle, options, [](const Problem& problem, const Options& each) { return SolverType(problem, each); }) {}

  /// `make(problem, options)` returns a SolverType.
  template <class Make>
  TickAllocator(const Vehicle& vehicle, const Options& options, Make&& make)
      : linear_(vehicle),
        problem_(vehicle),
        solver_(make(std::as_const(problem_), with_warm_start(options, true, kMaxWarmIterations))),
        rescue_(make(std::as_const(problem_), with_warm_start(options, false, kMaxIterations))),
        hard_limits_(vehicle.hard_limits) {
    for (int i = 0; i < N; ++i) {
      const Rotor& rotor = vehicle.rotors[std::size_t(i)];
      throttle_lower_[i] = rotor.throttle_lower, throttle_upper_[i] = rotor.throttle_upper;
      angle_lower_[i] = rotor.angle_lower, angle_upper_[i] = rotor.angle_upper;
      rate_limit_[i] = rotor.angle_rate_limit;
    }
    for (Vector* v : {&u_linear_, &a_linear_, &previous_, &out_.throttle, &out_.angle}) v->setZero(N);
  }

  void reset() override {
    previous_.setZero();
    has_previous_ = has_point_ = false;
    predictor_.reset();
  }

  void reset(ConstVectorRef angles) override {
    previous_ = angles;
    has_previous_ = true;
    has_point_ = false;
    predictor_.reset();
  }

  void fail_rotor(int i) override {
    linear_.fail_rotor(i);
    problem_.fail_rotor(i);
    throttle_lower_[i] = throttle_upper_[i] = 0;
  }

  void stick_servo(int i) override {
    linear_.stick_servo(i, previous_[i]);
    problem_.stick_servo(i, previous_[i]);
    angle_lower_[i] = angle_upper_[i] = previous_[i];
  }

  const Allocation& allocate(const Wrench& wrench, double dt) override {
    const auto begin = std::chrono::steady_clock::now();
    out_.iterations = 0;
    problem_.set_wrench(wrench);
    if (has_previous_) problem_.set_previous(previous_.array(), dt);
    else problem_.forget_previous();

    const bool usable = hard_limits_ ? solve_with_bounds(wrench, dt) : solve_with_penalties(wrench);
    if (!usable) fall_back(wrench, dt);

    previous_ = out_.angle;
    has_previous_ = true;
    out_.elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return out_;
  }

 private:
  static Options with_warm_start(Options options, bool warm, int max_iterations) {
    options.warm_start = warm;
    options.min_iterations = 1;  // a command is never a mere prediction
    options.max_iterations = std::min(options.max_iterations, max_iterations);
    return options;
  }

  bool solve_with_bounds(const Wrench& wrench, double dt) {
    linear_.solve(wrench, previous_, u_linear_, a_linear_);
    problem_.set_wrench_stiffness(kStiffness);
    start_at_branch(wrench, dt);
    predict();
    if (attempt(solver_)) return settle(wrench);

    // A wrench out of reach: scaled so that the wrench error is what is minimised and the effort a faint addition, and from a start that
    // trusts no guess.
    problem_.set_wrench_stiffness(1);
    problem_.set_effort_scale(kFaintEffort);
    start_at_branch(wrench, dt);
    bool usable = attempt(rescue_);
    if (!usable && has_previous_) {
      start_at_branch(wrench, dt);
      point_.x.template tail<N>() = previous_;
      usable = attempt(rescue_);
    }
    problem_.set_effort_scale(1);
    if (!usable) return false;
    if (!nearly_met()) return judge(wrench);

    // it was in reach after all: firm rows again, from there
    problem_.set_wrench_stiffness(kStiffness);
    point_.lambda /= kFaintEffort;
    point_.z /= kFaintEffort;
    problem_.set_preload(point_.lambda);
    attempt(solver_);
    return settle(wrench);
  }

  /// x at the arms' reference; an arm that the rate limit holds back starts at its bound, with a multiplier that says so.
  void start_at_branch(const Wrench& wrench, double dt) {
    Lanes branch = a_linear_.array();
    point_.z.setZero();
    for (int i = 0; i < N; ++i) {
      while (branch[i] > angle_upper_[i] && branch[i] - 2 * M_PI >= angle_lower_[i]) branch[i] -= 2 * M_PI;
      while (branch[i] < angle_lower_[i] && branch[i] + 2 * M_PI <= angle_upper_[i]) branch[i] += 2 * M_PI;
      branch[i] = std::clamp(branch[i], angle_lower_[i], angle_upper_[i]);
      if (!has_previous_) continue;
      const double most = rate_limit_[i] * dt, wanted = kBranchGain * (branch[i] - previous_[i]);
      branch[i] = previous_[i] + std::clamp(wanted, -most, most);
      if (std::abs(wanted) > most) point_.z[N + i] = std::copysign(kGuessedMultiplier, wanted);
    }
    problem_.set_branch(branch);
    const Lanes astray = (a_linear_.array() - branch).cos().max(kLeastCosine);
    point_.x.template head<N>() = (u_linear_.array() * astray).max(throttle_lower_).min(throttle_upper_).matrix();
    point_.x.template tail<N>() = branch.matrix();
    point_.lambda = problem_.throttle_weight() * linear_.effort_multipliers(wrench);
    problem_.set_preload(point_.lambda);
  }

  /// Rows that give way a little because the multipliers differ from their preload are made exact: the preload follows.
  bool settle(const Wrench& wrench) {
    for (int k = 0; k < kMaxSettlings && !met(wrench) && nearly_met(); ++k) {
      const double before = out_.error.template lpNorm<Eigen::Infinity>();
      problem_.set_preload(point_.lambda);
      if (!attempt(solver_) || out_.error.template lpNorm<Eigen::Infinity>() > kSettling * before) break;
    }
    return judge(wrench);
  }

  bool judge(const Wrench& wrench) {
    if (has_point_) {
      guess_ << point_.x, point_.lambda;
      predictor_.learn(guess_);
    }
    out_.status = met(wrench) ? AllocationStatus::solved : AllocationStatus::best_effort;
    return true;
  }

  bool solve_with_penalties(const Wrench& wrench) {
    problem_.set_wrench_stiffness(0);
    if (has_previous_ && has_point_) {
      predict();
      if (attempt(solver_)) return judge(wrench);
    }
    linear_.solve(wrench, previous_, u_linear_, a_linear_);
    start_at_linear(wrench);
    if (attempt(solver_)) return judge(wrench);
    // many kinks of the penalties in the way: with patience, and from several angles between the linear solution's and the tick before's
    for (const double back : {0.0, 0.5, 1.0, 0.25, 0.75}) {
      if (back > 0 && !has_previous_) break;
      start_at_linear(wrench);
      point_.x.template tail<N>() += back * (previous_ - a_linear_);
      if (attempt(rescue_)) return judge(wrench);
    }
    // a vehicle that cannot make every wrench, or a singular pose: rows that may give way
    problem_.set_wrench_stiffness(1 / kFaintEffort);
    problem_.set_preload(Wrench::Zero());
    start_at_linear(wrench);
    return attempt(rescue_) && judge(wrench);
  }

  /// From the guess in point_ to a better start, where the last ticks give one.
  void predict() {
    guess_ << point_.x, point_.lambda;
    const Guess& start = predictor_.predict(guess_);
    point_.x = start.template head<2 * N>();
    point_.lambda = start.template tail<6>();
  }

  void start_at_linear(const Wrench& wrench) {
    point_.x << u_linear_, a_linear_;
    point_.lambda = problem_.throttle_weight() * linear_.effort_multipliers(wrench);
    point_.z.setZero();
  }

  /// Solves from point_; takes the command over where the solver succeeded.
  bool attempt(SolverType& solver) {
    const Result result = solver.solve(point_);
    out_.iterations += result.iterations;
    has_point_ = succeeded(result.status);
    if (!has_point_) {
      predictor_.reset();
      return false;
    }
    out_.objective = result.objective / problem_.effort_scale();
    out_.residual = result.residual.max();
    out_.throttle = point_.x.template head<N>();
    out_.angle = point_.x.template tail<N>();
    out_.error = solver.constraints();
    return true;
  }

  bool met(const Wrench& wrench) const {
    return out_.error.template lpNorm<Eigen::Infinity>() <= kMetRelative * std::max(1.0, wrench.template lpNorm<Eigen::Infinity>());
  }
  bool nearly_met() const { return out_.error.template lpNorm<Eigen::Infinity>() <= kNearlyMet; }

  /// The linear solution, clipped to the limits.
  void fall_back(const Wrench& wrench, double dt) {
    out_.status = AllocationStatus::fallback;
    predictor_.reset();
    out_.throttle = u_linear_.array().max(throttle_lower_).min(throttle_upper_).matrix();
    out_.angle = a_linear_;
    if (has_previous_ && hard_limits_) {
      const Lanes most = rate_limit_ * dt;
      out_.angle = a_linear_.array().max(previous_.array() - most).min(previous_.array() + most).matrix();
    }
    out_.angle = out_.angle.array().max(angle_lower_).min(angle_upper_).matrix();
    out_.error = linear_.wrench(out_.throttle, out_.angle) - wrench;
    out_.objective = problem_.throttle_weight() * out_.throttle.squaredNorm();  // the effort alone
    out_.residual = kInfinity<double>;
    point_.lambda = problem_.throttle_weight() * linear_.effort_multipliers(wrench);
  }

  static constexpr int kMaxIterations = 60;
  static constexpr int kMaxWarmIterations = 14;
  static constexpr int kMaxSettlings = 3;
  static constexpr double kSettling = 0.1;           // what is out of reach does not settle
  static constexpr double kStiffness = 1e6;          // an attainable wrench gives way by 1e-6 times the change of the multipliers
  static constexpr double kFaintEffort = 1e-4;       // per unit of weighted squared wrench error
  static constexpr double kMetRelative = 1e-8;
  static constexpr double kNearlyMet = 1e-2;         // N, N m: beyond, the limits are in the way
  static constexpr double kBranchGain = 0.2;         // per tick; small enough to filter noise, large enough not to lag at 1 rad/s
  static constexpr double kGuessedMultiplier = 1e-2;
  static constexpr double kLeastCosine = 0.1;

  LinearAllocation linear_;
  Problem problem_;
  SolverType solver_, rescue_;
  using Guess = Eigen::Matrix<double, 2 * N + 6, 1>;  // x and lambda
  TickPredictor<Guess> predictor_;
  Guess guess_;
  PointOf<Problem> point_;
  Vector u_linear_, a_linear_;  // N
  Vector previous_;             // N, rad
  Lanes throttle_lower_, throttle_upper_, angle_lower_, angle_upper_, rate_limit_;
  bool hard_limits_;
  bool has_previous_ = false;  // rates count from previous_
  bool has_point_ = false;     // point_ is the solution of the tick before
  Allocation out_;
};

}  // namespace tenon
