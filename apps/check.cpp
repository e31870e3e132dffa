// tenon check PROBLEM: derivatives against differences, pattern, bounds, start.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tenon/apps/json.hpp"
#include "tenon/apps/named_problem.hpp"
#include "tenon/apps/verb.hpp"
#include "tenon/core/check_derivatives.hpp"
#include "tenon/core/solver.hpp"

namespace tenon {

namespace {

constexpr double kDerivativeTolerance = 1e-6;
constexpr int kRandomPoints = 5;

double within(double value, double lower, double upper) {
  return std::min(std::max(value, lower), upper);
}

/// Points about the start, within the bounds.
Vector random_point(const Vector& start, const Bounds& bounds, std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  Vector x = start;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    x[i] = within(x[i] + 0.2 * std::max(1.0, std::abs(x[i])) * uniform(random), bounds.x_lower[i], bounds.x_upper[i]);
  }
  return x;
}

void merge(DerivativeReport& all, const DerivativeReport& one) {
  all.gradient_error = std::max(all.gradient_error, one.gradient_error);
  all.jacobian_error = std::max(all.jacobian_error, one.jacobian_error);
  all.hessian_error = std::max(all.hessian_error, one.hessian_error);
  all.finite = all.finite && one.finite;
  all.worst.insert(all.worst.end(), one.worst.begin(), one.worst.end());
}

/// How far x lies outside its bounds at most.
double outside(const Vector& x, const Bounds& bounds) {
  double most = 0;
  for (Eigen::Index i = 0; i < x.size(); ++i) most = std::max({most, bounds.x_lower[i] - x[i], x[i] - bounds.x_upper[i]});
  return most;
}

}  // namespace

int run_check(const Arguments& arguments) {
  const NamedProblem named = load_problem(arguments.names.front());
  const std::unique_ptr<Nlp>& problem = named.problem;
  const double tolerance = arguments.tolerance.value_or(kDerivativeTolerance);
  const int n = problem->num_variables(), m = problem->num_constraints();
  Bounds bounds(n, m);
  problem->bounds(bounds);
  validate(*problem, bounds);
  const Vector& start = named.start.x;

  std::mt19937_64 random(arguments.seed);
  std::normal_distribution<double> normal;
  DerivativeReport report;
  for (int k = 0; k <= kRandomPoints; ++k) {
    Vector lambda(m);
    for (double& l : lambda) l = normal(random);
    merge(report, check_derivatives(*problem, k == 0 ? start : random_point(start, bounds, random), 1, lambda, tolerance));
  }
  const bool passed = report.passed(tolerance);
  const SparsePattern jacobian = problem->jacobian_pattern(), hessian = problem->hessian_pattern();

  if (arguments.json) {
    print(Json::object()
              .set("schema", 1)
              .set("problem", named.name)
              .set("passed", passed)
              .set("finite", report.finite)
              .set("tolerance", tolerance)
              .set("points", kRandomPoints + 1)
              .set("variables", n)
              .set("constraints", m)
              .set("jacobian_nonzeros", jacobian.nonzeros())
              .set("hessian_nonzeros", hessian.nonzeros())
              .set("start_outside_bounds", outside(start, bounds))
              .set("error", Json::object()
                                .set("gradient", report.gradient_error)
                                .set("jacobian", report.jacobian_error)
                                .set("hessian", report.hessian_error)));
    return passed ? kFinished : kNotSolved;
  }
  const auto verdict = [tolerance](double error) { return error <= tolerance ? "as differences say" : "WRONG"; };
  fmt::print("{}: {} variables, {} constraints\n", named.name, n, m);
  fmt::print("  gradient   relative error {:.1e}, {}\n", report.gradient_error, verdict(report.gradient_error));
  fmt::print("  Jacobian   relative error {:.1e}, {}; {} of {} entries\n", report.jacobian_error, verdict(report.jacobian_error),
             jacobian.nonzeros(), static_cast<long>(n) * m);
  fmt::print("  Hessian    relative error {:.1e}, {}; {} of {} entries of the lower triangle\n", report.hessian_error,
             verdict(report.hessian_error), hessian.nonzeros(), static_cast<long>(n) * (n + 1) / 2);
  fmt::print("  bounds     in order; the start is {}\n",
             outside(start, bounds) > 0 ? fmt::format("{:.3g} outside", outside(start, bounds)) : "within");
  if (!report.finite) fmt::print("  some function or derivative is not finite at a point that was looked at\n");
  for (const DerivativeError& e : report.worst) {
    fmt::print("  {} {} by {}: {:.9g}, difference {:.9g}\n", e.what, e.row, e.variable, e.analytic, e.difference);
  }
  return passed ? kFinished : kNotSolved;
}

}  // namespace tenon
