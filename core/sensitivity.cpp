#include "tenon/core/sensitivity.hpp"

#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <vector>

#include "tenon/core/first_order.hpp"
#include "tenon/core/solver.hpp"

namespace tenon {

namespace {

/// Whether the bound that the multiplier points at is active; lowers `gap` to how clear that is.
bool is_active(double value, double lower, double upper, double multiplier, double& gap) {
  if (lower == upper) return true;
  const double bound = multiplier > 0 ? upper : lower, distance = std::abs(value - bound), size = std::abs(multiplier);
  if (std::isfinite(bound)) gap = std::min(gap, std::max(distance, size));
  return size > distance;
}

/// The place of each free variable, then of each active row, in (1); -1 for the others.
struct ActiveSet {
  std::vector<int> x, c;
  int size = 0;
  double gap = kInfinity<double>;

  ActiveSet(const Point& point, const Bounds& bounds, const Vector& rows)
      : x(std::size_t(point.x.size()), -1), c(std::size_t(point.lambda.size()), -1) {
    for (Eigen::Index i = 0; i < point.x.size(); ++i) {
      if (!is_active(point.x[i], bounds.x_lower[i], bounds.x_upper[i], point.z[i], gap)) x[std::size_t(i)] = size++;
    }
    for (Eigen::Index j = 0; j < point.lambda.size(); ++j) {
      if (is_active(rows[j], bounds.c_lower[j], bounds.c_upper[j], point.lambda[j], gap)) c[std::size_t(j)] = size++;
    }
  }
};

SparseMatrix whole_hessian(const Nlp& problem, const Point& point, Nlp::Workspace& workspace) {
  SparseMatrix lower = problem.hessian_pattern().zero_matrix();
  problem.hessian(point.x, 1, point.lambda, workspace, values_of(lower));
  return lower.selfadjointView<Eigen::Lower>();
}

SparseMatrix kkt_matrix(const SparseMatrix& hessian, const SparseMatrix& jacobian, const Vector& compliance, const ActiveSet& active) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < hessian.cols(); ++i) {
    const int at = active.x[std::size_t(i)];
    if (at < 0) continue;
    for (SparseMatrix::InnerIterator entry(hessian, i); entry; ++entry) {
      const int to = active.x[std::size_t(entry.row())];
      if (to >= 0) entries.emplace_back(to, at, entry.value());
    }
    for (SparseMatrix::InnerIterator entry(jacobian, i); entry; ++entry) {
      const int to = active.c[std::size_t(entry.row())];
      if (to >= 0) entries.emplace_back(to, at, entry.value()), entries.emplace_back(at, to, entry.value());
    }
  }
  for (int j = 0; j < jacobian.rows(); ++j) {
    const int at = active.c[std::size_t(j)];
    if (at >= 0) entries.emplace_back(at, at, -compliance[j]);
  }
  SparseMatrix kkt(active.size, active.size);
  kkt.setFromTriplets(entries.begin(), entries.end());
  return kkt;
}

/// The solution of a regular system; nothing where the matrix is singular, or only rounding keeps it from being so.
std::optional<Eigen::MatrixXd> solve(const SparseMatrix& matrix, const Eigen::MatrixXd& right) {
  if (right.size() == 0) return right;
  constexpr double kSolved = 1e-8, kGrowth = 1e12;
  Eigen::SparseLU<SparseMatrix> lu;
  lu.compute(matrix);
  if (lu.info() != Eigen::Success) return std::nullopt;
  const Eigen::MatrixXd solution = lu.solve(right);
  const double size = std::max(1.0, right.norm());
  const bool is_regular = solution.allFinite() && solution.norm() <= kGrowth * size && (matrix * solution - right).norm() <= kSolved * size;
  return is_regular ? std::optional(solution) : std::nullopt;
}

/// The rows of `part` that have a place among those of `all`.
void gather(const Eigen::MatrixXd& part, const std::vector<int>& place, Eigen::MatrixXd& all) {
  for (std::size_t i = 0; i < place.size(); ++i) {
    if (place[i] >= 0) all.row(place[i]) = part.row(Eigen::Index(i));
  }
}
void scatter(const Eigen::MatrixXd& all, const std::vector<int>& place, Eigen::MatrixXd& part) {
  for (std::size_t i = 0; i < place.size(); ++i) {
    if (place[i] >= 0) part.row(Eigen::Index(i)) = all.row(place[i]);
  }
}

}  // namespace

Sensitivity sensitivity(const ParametricNlp& problem, const Point& point) {
  validate(problem, point);
  refuse_soft_rows(problem);
  if (problem.hessian_kind() != HessianKind::exact) {
    throw std::invalid_argument("sensitivity of " + problem.name() + ": its Hessian is not exact (expected one that is)");
  }
  const int n = problem.num_variables(), m = problem.num_constraints(), q = problem.num_parameters();
  Bounds bounds(n, m);
  problem.bounds(bounds);
  const FirstOrder here(problem, point.x);
  Nlp::Workspace workspace = problem.make_workspace();
  problem.prepare(point.x, workspace);
  const SparseMatrix hessian = whole_hessian(problem, point, workspace);
  ParameterDerivatives by_p{Eigen::MatrixXd::Zero(n, q), Eigen::MatrixXd::Zero(m, q), Eigen::MatrixXd::Zero(n, q)};
  problem.parameter_derivatives(point.x, point.lambda, workspace, by_p);
  const ActiveSet active(point, bounds, here.constraints - bounds.compliance.cwiseProduct(point.lambda - bounds.preload));

  Sensitivity out{Eigen::MatrixXd::Zero(n, q), Eigen::MatrixXd::Zero(m, q), Eigen::MatrixXd::Zero(n, q), false, active.gap};
  Eigen::MatrixXd x = by_p.bounds;  // x_B'; the free ones follow
  scatter(Eigen::MatrixXd::Zero(active.size, q), active.x, x);
  Eigen::MatrixXd right(active.size, q);
  gather(-by_p.gradient - hessian * x, active.x, right);
  gather(-by_p.rows - here.jacobian * x, active.c, right);
  const std::optional<Eigen::MatrixXd> solution = solve(kkt_matrix(hessian, here.jacobian, bounds.compliance, active), right);
  if (!solution) return out;

  out.is_unique = true;
  out.x = x;
  scatter(*solution, active.x, out.x);
  scatter(*solution, active.c, out.lambda);
  out.z = -(by_p.gradient + hessian * out.x + here.jacobian.transpose() * out.lambda);
  scatter(Eigen::MatrixXd::Zero(active.size, q), active.x, out.z);
  return out;
}

}  // namespace tenon
