#include "tenon/mpc/receding_horizon.hpp"

#include <chrono>
#include <cmath>
#include <stdexcept>

#include "tenon/mpc/shift_plan.hpp"

namespace tenon {

namespace {

constexpr double kRounding = 1e-9;  // of times, in intervals

constexpr const char* kLogNames[] = {"iterations", "violation", "fallback"};
constexpr int kLogSize = 3;

void check(const std::string& what, int found, int expected) {
  if (found == expected) return;
  throw std::invalid_argument(what + " are " + std::to_string(found) + " (expected " + std::to_string(expected) + ", as of the program)");
}

}  // namespace

RecedingHorizon::RecedingHorizon(std::unique_ptr<HorizonProgram> program, std::unique_ptr<Estimator> estimator,
                                 const SolverFactory& make_solver, const HorizonOptions& options, double period)
    : program_(std::move(program)),
      estimator_(std::move(estimator)),
      stages_(program_->stages()),
      cold_(make_solver(*program_, options.cold)),
      warm_(make_solver(*program_, options.warm)),
      largest_violation_(options.largest_violation),
      delay_(options.delay),
      period_(period),
      ahead_(program_->num_variables(), program_->num_constraints()),
      plan_(ahead_),
      trial_(ahead_),
      estimates_(Vector::Zero(program_->num_estimates())),
      commands_(Vector::Zero(program_->num_commands())),
      covariance_(Eigen::MatrixXd::Zero(estimates_.size(), estimates_.size())) {
  if (!(period_ > 0) || period_ > (1 + kRounding) * program_->interval()) {
    throw std::invalid_argument("the period of a receding horizon is " + std::to_string(period_) + " s (expected more than 0, at most a stage, " +
                                std::to_string(program_->interval()) + " s)");
  }
  if (!(delay_ >= 0) || !std::isfinite(delay_)) {
    throw std::invalid_argument("the delay of a receding horizon is " + std::to_string(delay_) + " s (expected a finite one, at least 0)");
  }
  check("estimates", estimator_ ? estimator_->num_estimates() : 0, program_->num_estimates());
  if (estimator_) check("the estimator's measurements", estimator_->num_measurements(), program_->num_measurements());
  plan_ahead(make_solver, options.ahead);
  reset();
}

RecedingHorizon::~RecedingHorizon() = default;

void RecedingHorizon::reset() {
  if (estimator_) {
    estimator_->reset();
    estimator_->mean(estimates_);
    estimator_->covariance(covariance_);
  }
  commands_.setZero();
  plan_ = ahead_;
  basis_ = has_ahead_ ? Basis::expectation : Basis::nothing;
  start_ = 0;
  failed_ = false;
  log_ = {};
}

void RecedingHorizon::plan_ahead(const SolverFactory& make_solver, const Options& options) {
  const std::unique_ptr<Solver> solver = make_solver(*program_, options);
  start_afresh(trial_);
  has_ahead_ = is_usable(solve(*solver));
  if (has_ahead_) ahead_ = trial_;
}

void RecedingHorizon::update(double t, ConstVectorRef measurements, VectorRef commands) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  estimate(t, measurements);
  program_->observe(t, measurements, estimates_);
  shift_to(t);
  accept(t, solve_from_guess());
  program_->commands(plan_, t - start_ + delay_, commands_);
  commands = commands_;
  log_.elapsed = std::chrono::duration<double>(Clock::now() - begin).count();
}

void RecedingHorizon::estimate(double t, ConstVectorRef measurements) {
  if (!estimator_) return;
  estimator_->update(t, measurements, commands_);
  estimator_->mean(estimates_);
  estimator_->covariance(covariance_);
}

/// Until the plan's first stage is the one that holds t. What was expected is expected of the first tick, whenever that is.
void RecedingHorizon::shift_to(double t) {
  if (basis_ != Basis::measurement) start_ = t;
  const double interval = program_->interval();
  while (t - start_ > (1 - kRounding) * interval) {
    shift_plan(stages_, plan_);
    start_ += interval;
  }
}

void RecedingHorizon::start_afresh(Point& plan) const {
  program_->initial_point(plan.x);
  plan.lambda.setZero();
  plan.z.setZero();
}

Result RecedingHorizon::solve_from_guess() {
  int iterations = 0;
  if (basis_ != Basis::nothing && !failed_ && !program_->wants_fresh_start()) {
    trial_ = plan_;
    const Result warm = solve(*warm_);
    if (basis_ == Basis::measurement || is_usable(warm)) return warm;
    iterations = warm.iterations;  // the plant is not where it was expected
  }
  start_afresh(trial_);
  Result cold = solve(*cold_);
  cold.iterations += iterations;
  return cold;
}

Result RecedingHorizon::solve(Solver& solver) {
  try {
    return solver.solve(trial_);
  } catch (const std::invalid_argument&) {  // bounds that cross: what was observed makes no sense
    Result result;
    result.status = Status::invalid_start;
    result.residual.primal = kInfinity<double>;
    return result;
  }
}

bool RecedingHorizon::is_usable(const Result& result) const {
  return result.residual.primal <= largest_violation_ && trial_.x.allFinite();
}

void RecedingHorizon::accept(double t, const Result& result) {
  log_ = {result.status, result.iterations, result.residual.primal, PlanSource::solved, 0};
  failed_ = !is_usable(result);
  if (!failed_) {
    std::swap(plan_, trial_);
    if (!succeeded(result.status)) log_.source = PlanSource::iterate;
  } else if (basis_ == Basis::measurement) {
    log_.source = PlanSource::shifted;
    return;
  } else {
    start_afresh(plan_);
    log_.source = PlanSource::initial;
  }
  start_ = t;
  basis_ = Basis::measurement;
}

int RecedingHorizon::num_outputs() const {
  const int estimates = static_cast<int>(estimates_.size());
  return estimates + estimates * (estimates + 1) / 2 + kLogSize + program_->num_plan_outputs();
}

std::string RecedingHorizon::output_name(int i) const {
  const int estimates = static_cast<int>(estimates_.size());
  if (i < estimates) return estimator_->estimate_name(i);
  i -= estimates;
  const int covariances = estimates * (estimates + 1) / 2;
  if (i < covariances) return covariance_names(*estimator_)[static_cast<std::size_t>(i)];
  i -= covariances;
  return i < kLogSize ? kLogNames[i] : program_->plan_output_name(i - kLogSize);
}

void RecedingHorizon::outputs(VectorRef values) const {
  const Eigen::Index estimates = estimates_.size();
  values.head(estimates) = estimates_;
  Eigen::Index next = estimates;
  for (Eigen::Index column = 0; column < estimates; ++column) {
    for (Eigen::Index row = column; row < estimates; ++row) values[next++] = covariance_(row, column);
  }
  values[next++] = log_.iterations;
  values[next++] = log_.violation;
  values[next++] = log_.fell_back() ? 1 : 0;
  program_->plan_outputs(plan_, values.tail(values.size() - next));
}

}  // namespace tenon
