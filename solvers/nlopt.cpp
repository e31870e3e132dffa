// Four local methods of NLopt, judged.
//
// NLopt returns no multipliers and stops on small steps, not on residuals. So its tolerances are set near the rounding, multipliers come
// from least squares, and the verdict is the ruler's: `solved` as everywhere; `acceptable` also where the residual is within 1e-5 of the
// gradient's size, because who compares objective values resolves x to the root of the rounding and no better; else a stop on small steps
// is a numerical_failure (or infeasible, local_infeasibility.hpp). NLopt returns the lowest objective among points feasible within
// tolerance, which may be an early one, or the start where none was: the ruler chooses between that and the last point whose gradient
// NLopt wanted.
// MMA and CCSAQ want a start that satisfies the rows: from elsewhere they may run away.
#include "tenon/solvers/nlopt.hpp"

#include <algorithm>
#include <stdexcept>

#include "tenon/solvers/adapter.hpp"
#include "tenon/solvers/local_infeasibility.hpp"
#include "tenon/solvers/least_squares_multipliers.hpp"
#include "tenon/solvers/nlopt_run.hpp"

namespace tenon {

namespace {

struct Method {
  NloptMethod method;
  const char* name;
  const char* description;
  bool takes_equalities;
};

constexpr Method kSlsqp = {NloptMethod::slsqp, "nlopt-slsqp", "sequential least-squares programming", true};
constexpr Method kMma = {NloptMethod::mma, "nlopt-mma", "method of moving asymptotes, no equalities", false};
constexpr Method kCcsaq = {NloptMethod::ccsaq, "nlopt-ccsaq", "conservative convex separable approximations, no equalities", false};
constexpr Method kAuglag = {NloptMethod::auglag, "nlopt-auglag", "augmented Lagrangian over L-BFGS", true};

constexpr double kResolved = 1e-5;  // residual per size of the gradient that a method without residuals can reach

class NloptSolver final : public Solver {
 public:
  NloptSolver(const Method& method, const Nlp& problem, const Options& options) : method_(method), problem_(problem), options_(options) {
    validate(options);
    checked_bounds();
  }

  Result solve(Point& point) override {
    validate(problem_, point);
    const Bounds bounds = checked_bounds();
    point.x = point.x.cwiseMax(bounds.x_lower).cwiseMin(bounds.x_upper);

    Result result;
    if (!FirstOrder(problem_, point.x).all_finite()) {
      result.status = Status::invalid_start;
    } else if (options_.max_iterations == 0) {
      result.status = Status::iteration_limit;  // NLopt's maxeval 0 would mean no limit
    } else {
      const NloptRun run = run_nlopt(method_.method, problem_, bounds, options_, point.x);
      result.iterations = run.evaluations;
      result.elapsed = run.elapsed;
      point = better_of(with_least_squares_multipliers(problem_, bounds, run.x),
                        with_least_squares_multipliers(problem_, bounds, run.last_iterate));
      result.status = status_of(run.end, bounds, point);
    }
    result.residual = kkt_residual(problem_, point);
    result.objective = PreparedNlp(problem_).objective(point.x);
    return result;
  }

 private:
  Point better_of(const Point& returned, const Point& last) const {
    return kkt_residual(problem_, last).max_scaled() < kkt_residual(problem_, returned).max_scaled() ? last : returned;
  }

  Status status_of(NloptEnd end, const Bounds& bounds, const Point& point) const {
    switch (end) {
      case NloptEnd::evaluations: return Status::iteration_limit;
      case NloptEnd::time: return Status::time_limit;
      case NloptEnd::unbounded: return Status::unbounded;
      case NloptEnd::observer: return Status::stopped;
      case NloptEnd::not_finite: return Status::numerical_failure;
      case NloptEnd::no_progress: break;
    }
    const KktResidual residual = kkt_residual(problem_, point);
    const Status status = judged(residual, options_.tolerance);
    if (status != Status::numerical_failure) return status;
    const FirstOrder here(problem_, point.x);
    if (residual.max_scaled() <= kResolved * std::max(1.0, here.gradient.lpNorm<Eigen::Infinity>())) return Status::acceptable;
    return is_locally_infeasible(point.x, bounds, here) ? Status::infeasible : status;
  }

  Bounds checked_bounds() const {
    Bounds bounds = hard_bounds(problem_, method_.name);
    if (!method_.takes_equalities && (bounds.c_lower.array() == bounds.c_upper.array()).any()) {
      throw std::invalid_argument(std::string("solver \"") + method_.name + "\" takes no equality rows, and " + problem_.name() +
                                  " has some (nlopt-slsqp and nlopt-auglag take them)");
    }
    return bounds;
  }

  const Method& method_;
  const Nlp& problem_;
  Options options_;
};

SolverDescription describe(const Method& method) {
  std::string options = "ftol_rel = xtol_rel = 1e-15, tolerance of each row = tolerance, stopval -1e20, maxeval = max_iterations";
  if (method.method == NloptMethod::auglag) options += ", local optimizer LD_LBFGS with the same ftol_rel and xtol_rel";
  return {method.name, std::string(method.description) + ", NLopt " + nlopt_library_version(), true, options};
}

std::unique_ptr<Solver> make(const Method& method, const Nlp& problem, const Options& options) {
  return std::make_unique<NloptSolver>(method, problem, options);
}

}  // namespace

SolverDescription describe_nlopt_slsqp() { return describe(kSlsqp); }
SolverDescription describe_nlopt_mma() { return describe(kMma); }
SolverDescription describe_nlopt_ccsaq() { return describe(kCcsaq); }
SolverDescription describe_nlopt_auglag() { return describe(kAuglag); }

std::unique_ptr<Solver> make_nlopt_slsqp(const Nlp& problem, const Options& options) { return make(kSlsqp, problem, options); }
std::unique_ptr<Solver> make_nlopt_mma(const Nlp& problem, const Options& options) { return make(kMma, problem, options); }
std::unique_ptr<Solver> make_nlopt_ccsaq(const Nlp& problem, const Options& options) { return make(kCcsaq, problem, options); }
std::unique_ptr<Solver> make_nlopt_auglag(const Nlp& problem, const Options& options) { return make(kAuglag, problem, options); }

}  // namespace tenon
