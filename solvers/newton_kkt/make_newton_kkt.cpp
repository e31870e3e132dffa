#include "tenon/solvers/newton_kkt/make_newton_kkt.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "tenon/core/quasi_newton_nlp.hpp"
#include "tenon/core/scaled_nlp.hpp"
#include "tenon/solvers/newton_kkt/newton_kkt.hpp"

namespace tenon {

namespace {

/// The trace of the scaled problem, with the objective that the user knows.
Options in_user_units(Options options, const ScaledNlp& scaled) {
  if (options.on_iteration) {
    options.on_iteration = [observer = options.on_iteration, &scaled](Iteration iteration) {
      iteration.objective /= scaled.objective_factor();
      return observer(iteration);
    };
  }
  return options;
}

/// Solves the scaled problem and answers for the problem itself.
template <class Kkt>
class NlpNewtonKkt final : public Solver {
 public:
  NlpNewtonKkt(const Nlp& problem, const Options& options)
      : problem_(problem),
        options_(options),
        bounds_(problem.num_variables(), problem.num_constraints()),
        approximation_(approximation_of(problem)),
        scaled_(approximation_ ? static_cast<const Nlp&>(*approximation_) : problem),
        solver_(scaled_, in_user_units(options, scaled_)),
        workspace_(problem.make_workspace()),
        jacobian_(problem.jacobian_pattern().zero_matrix()) {
    gradient_.resize(problem.num_variables());
    beside_.resize(problem.num_variables());
    rows_.resize(problem.num_constraints());
  }

  Result solve(Point& point) override {
    validate(problem_, point);
    bounds_.remove_limits();
    problem_.bounds(bounds_);
    validate(problem_, bounds_);
    choose_scale(point);
    if (approximation_ && !options_.warm_start) approximation_->forget();
    solver_.options().tolerance = tightened_tolerance();
    scaled_.scale(point);
    Result result = solver_.solve(point);
    scaled_.unscale(point);
    if (!scaled_.is_identity()) judge(point, result);
    if (!bears_out(result)) result.status = Status::numerical_failure;
    return result;
  }

 private:
  static std::optional<QuasiNewtonNlp> approximation_of(const Nlp& problem) {
    return problem.hessian_kind() == HessianKind::none ? std::optional<QuasiNewtonNlp>(problem) : std::nullopt;
  }

  /// By the derivatives at the start, and a step aside for rows that are flat there; a warm start keeps the scale of the solve before.
  void choose_scale(const Point& point) {
    if (!options_.scaling || (options_.warm_start && chosen_)) return;
    chosen_ = true;
    problem_.prepare(point.x, workspace_);
    problem_.gradient(point.x, workspace_, gradient_);
    problem_.jacobian(point.x, workspace_, values_of(jacobian_));
    scaled_.choose(gradient_, values_of(jacobian_));
    if (!scaled_.has_flat_rows()) return;
    beside_ = (point.x.array() + point.x.array().abs().max(1.0)).max(bounds_.x_lower.array()).min(bounds_.x_upper.array());
    problem_.prepare(beside_, workspace_);
    problem_.jacobian(beside_, workspace_, values_of(jacobian_));
    scaled_.choose_flat_rows(values_of(jacobian_));
  }

  /// Where the scale is moderate, the problem is to meet the tolerance in its own units too.
  double tightened_tolerance() const {
    const double tightened = options_.tolerance * std::max(scaled_.smallest_factor(), kMostTightened);
    return std::max(tightened, std::min(options_.tolerance, kFinest));
  }

  /// The answer in the problem's own units.
  void judge(const Point& point, Result& result) {
    result.objective /= scaled_.objective_factor();
    result.scaled_residual = result.residual;
    if (result.status == Status::acceptable || result.status == Status::numerical_failure) {  // by a tolerance that was tightened
      if (result.residual.max_scaled() <= kAcceptableFactor * options_.tolerance) result.status = Status::acceptable;
      if (result.residual.max_scaled() <= options_.tolerance) result.status = Status::solved;
    }
    if (result.status == Status::invalid_start) return;
    problem_.prepare(point.x, workspace_);
    problem_.gradient(point.x, workspace_, gradient_);
    problem_.constraints(point.x, workspace_, rows_);
    problem_.jacobian(point.x, workspace_, values_of(jacobian_));
    gradient_ += point.z;
    gradient_.noalias() += jacobian_.transpose() * point.lambda;
    rows_ -= bounds_.compliance.cwiseProduct(point.lambda - bounds_.preload);
    result.residual = kkt_residual(point, bounds_, gradient_, rows_);
  }

  /// Whether the residual is that of an answer: where a derivative is not finite nothing is known, and rows that are met are no conflict.
  bool bears_out(const Result& result) const {
    const bool infeasible = result.status == Status::infeasible;
    if (!infeasible && !succeeded(result.status)) return true;
    if (!std::isfinite(result.residual.stationarity)) return false;
    return !infeasible || result.scaled_residual.value_or(result.residual).primal > options_.tolerance;
  }

  static constexpr double kMostTightened = 1e-4, kFinest = 1e-13;

  const Nlp& problem_;
  Options options_;
  Bounds bounds_;
  std::optional<QuasiNewtonNlp> approximation_;  // where the problem has no Hessian
  ScaledNlp scaled_;
  NewtonKkt<Nlp, Kkt> solver_;
  bool chosen_ = false;

  Nlp::Workspace workspace_;  // of the problem itself: what its scale and its ruler read
  Vector gradient_, rows_, beside_;
  SparseMatrix jacobian_;
};

}  // namespace

std::unique_ptr<Solver> make_newton_kkt(const Nlp& problem, const Options& options) {
  validate(options);
  refuse_soft_rows(problem);
  const bool staged = !problem.stages().empty() && problem.hessian_kind() != HessianKind::none;
  if (staged) return std::make_unique<NlpNewtonKkt<StageKkt<>>>(problem, options);
  return std::make_unique<NlpNewtonKkt<SparseKkt>>(problem, options);
}

SolverDescription describe_newton_kkt() {
  return {"newton-kkt", "primal-dual interior point with filter line search, tenon's own", true,
          "exact Hessian (damped BFGS where a problem has none), stage-structured or multifrontal LDL', gradient-based scaling"};
}

}  // namespace tenon
