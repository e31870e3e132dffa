#include "tenon/core/check_derivatives.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace tenon {

namespace {

/// The first-order quantities at one x.
struct FirstOrder {
  double objective;
  Vector gradient, constraints;
  SparseMatrix jacobian;
};

class Evaluator {
 public:
  explicit Evaluator(const Nlp& problem)
      : problem_(problem), workspace_(problem.make_workspace()), jacobian_(problem.jacobian_pattern().zero_matrix()) {}

  FirstOrder at(const Vector& x) {
    FirstOrder out{0, Vector(problem_.num_variables()), Vector(problem_.num_constraints()), {}};
    problem_.prepare(x, workspace_);
    out.objective = problem_.objective(x, workspace_);
    problem_.gradient(x, workspace_, out.gradient);
    problem_.constraints(x, workspace_, out.constraints);
    problem_.jacobian(x, workspace_, values_of(jacobian_));
    out.jacobian = jacobian_;
    return out;
  }

  Eigen::MatrixXd hessian(const Vector& x, double sigma, const Vector& lambda) {
    SparseMatrix lower = problem_.hessian_pattern().zero_matrix();
    problem_.prepare(x, workspace_);
    problem_.hessian(x, sigma, lambda, workspace_, values_of(lower));
    return Eigen::MatrixXd(lower).selfadjointView<Eigen::Lower>();
  }

 private:
  const Nlp& problem_;
  Nlp::Workspace workspace_;
  SparseMatrix jacobian_;
};

/// Collects errors of one kind of derivative.
class Comparison {
 public:
  Comparison(std::string what, double tolerance, DerivativeReport& report, double& largest)
      : what_(std::move(what)), tolerance_(tolerance), report_(report), largest_(largest) {}

  /// `row` gives a name, which few entries need.
  void add(const auto& row, const std::string& variable, double analytic, double difference, double magnitude) {
    if (!std::isfinite(analytic) || !std::isfinite(difference)) {
      report_.finite = false;
      report_.worst.push_back({what_, row(), variable, analytic, difference, kInfinity<double>});
      return;
    }
    const double error = std::abs(analytic - difference) / std::max({1.0, std::abs(analytic), magnitude});
    largest_ = std::max(largest_, error);
    if (error > tolerance_) report_.worst.push_back({what_, row(), variable, analytic, difference, error});
  }

 private:
  std::string what_;
  double tolerance_;
  DerivativeReport& report_;
  double& largest_;
};

}  // namespace

DerivativeReport check_derivatives(const Nlp& problem, const Vector& x, double sigma, const Vector& lambda, double tolerance) {
  const int n = problem.num_variables(), m = problem.num_constraints();
  if (x.size() != n || lambda.size() != m) throw std::invalid_argument("check_derivatives: x or lambda has the wrong length");

  DerivativeReport report;
  Evaluator evaluate(problem);
  const FirstOrder here = evaluate.at(x);
  const Eigen::MatrixXd hessian = evaluate.hessian(x, sigma, lambda), jacobian = here.jacobian;
  const Vector scale = (sigma * here.gradient).cwiseAbs() + jacobian.cwiseAbs().transpose() * lambda.cwiseAbs();
  Comparison gradients("gradient", tolerance, report, report.gradient_error);
  Comparison jacobians("jacobian", tolerance, report, report.jacobian_error);
  Comparison hessians("hessian", tolerance, report, report.hessian_error);

  for (int j = 0; j < n; ++j) {
    const double h = std::cbrt(std::numeric_limits<double>::epsilon()) * std::max(1.0, std::abs(x[j]));
    Vector ahead = x, behind = x;
    ahead[j] += h;
    behind[j] -= h;
    const FirstOrder plus = evaluate.at(ahead), minus = evaluate.at(behind);
    const double width = ahead[j] - behind[j];
    const std::string variable = problem.variable_name(j);

    gradients.add([] { return std::string(); }, variable, here.gradient[j], (plus.objective - minus.objective) / width, std::abs(here.objective));
    for (int i = 0; i < m; ++i) {
      jacobians.add([&] { return problem.constraint_name(i); }, variable, jacobian(i, j), (plus.constraints[i] - minus.constraints[i]) / width,
                    std::abs(here.constraints[i]));
    }
    // d/dx_j of  sigma grad f + J' lambda
    const SparseMatrix change = plus.jacobian - minus.jacobian;
    const Vector column = (sigma * (plus.gradient - minus.gradient) + change.transpose() * lambda) / width;
    for (int i = 0; i < n; ++i) hessians.add([&] { return problem.variable_name(i); }, variable, hessian(i, j), column[i], scale[i]);
  }

  std::stable_sort(report.worst.begin(), report.worst.end(), [](const auto& a, const auto& b) { return a.error > b.error; });
  if (report.worst.size() > 20) report.worst.resize(20);
  return report;
}

}  // namespace tenon
