#include "tenon/core/with_soft_rows.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

namespace tenon {

namespace {

void check(const Nlp& problem, const std::vector<SoftRow>& soft) {
  std::set<int> seen;
  for (const SoftRow& s : soft) {
    if (s.row < 0 || s.row >= problem.num_constraints()) {
      throw std::invalid_argument("soft row " + std::to_string(s.row) + " of " + problem.name() + " does not exist (expected 0 to " +
                                  std::to_string(problem.num_constraints() - 1) + ")");
    }
    const std::string name = problem.constraint_name(s.row);
    if (!seen.insert(s.row).second) throw std::invalid_argument("row " + name + " is declared soft twice (expected one pair of weights)");
    const auto makes_sense = [](double weight) { return weight >= 0 && std::isfinite(weight); };
    if (!makes_sense(s.linear) || !makes_sense(s.quadratic) || s.linear + s.quadratic == 0) {
      throw std::invalid_argument("soft row " + name + " has the weights " + std::to_string(s.linear) + " and " +
                                  std::to_string(s.quadratic) + " (expected 0 or more, finite, not both 0)");
    }
  }
}

Bounds bounds_of(const Nlp& problem) {
  Bounds bounds(problem.num_variables(), problem.num_constraints());
  problem.bounds(bounds);
  return bounds;
}

}  // namespace

WithSoftRows::WithSoftRows(const Nlp& problem)
    : NlpDecorator(problem), soft_(problem.soft_rows()), n_(problem.num_variables()), m_(problem.num_constraints()) {
  check(problem, soft_);
  std::ranges::sort(soft_, {}, &SoftRow::row);
  linear_.resize(2 * count());
  quadratic_.resize(2 * count());
  for (int k = 0; k < count(); ++k) {
    linear_.segment<2>(2 * k).setConstant(soft_[std::size_t(k)].linear);
    quadratic_.segment<2>(2 * k).setConstant(soft_[std::size_t(k)].quadratic);
  }
}

Point WithSoftRows::lift(const Point& point) const {
  const Bounds inner = bounds_of(problem_);
  Vector rows(m_);
  Workspace workspace = problem_.make_workspace();
  problem_.prepare(point.x, workspace);
  problem_.constraints(point.x, workspace, rows);

  Point lifted(num_variables(), m_);
  lifted.x.head(n_) = point.x;
  lifted.z.head(n_) = point.z;
  lifted.lambda = point.lambda;
  for (int k = 0; k < count(); ++k) {
    const int j = soft_[std::size_t(k)].row;
    double &p = lifted.x[excess(k)], &n = lifted.x[shortfall(k)];
    if (rows[j] > inner.c_upper[j]) p = rows[j] - inner.c_upper[j];
    if (rows[j] < inner.c_lower[j]) n = inner.c_lower[j] - rows[j];
    lifted.z[excess(k)] = std::min(0.0, point.lambda[j] - linear_[2 * k] - quadratic_[2 * k] * p);
    lifted.z[shortfall(k)] = std::min(0.0, -point.lambda[j] - linear_[2 * k] - quadratic_[2 * k] * n);
  }
  return lifted;
}

void WithSoftRows::lower(const Point& lifted, Point& point) const {
  point.x = lifted.x.head(n_);
  point.z = lifted.z.head(n_);
  point.lambda = lifted.lambda;
}

double WithSoftRows::price(ConstVectorRef x) const {
  const auto slacks = x.tail(2 * count());
  return slacks.dot(linear_) + 0.5 * slacks.cwiseAbs2().dot(quadratic_);
}

// J = [ J_c  -e_0  e_0  -e_1  e_1 ... ],  e_k: the unit column of soft row k
SparsePattern WithSoftRows::jacobian_pattern() const {
  SparsePattern pattern = problem_.jacobian_pattern();
  for (int k = 0; k < 2 * count(); ++k) {
    pattern.inner.push_back(soft_[std::size_t(k / 2)].row);
    pattern.outer.push_back(pattern.nonzeros());
  }
  pattern.cols += 2 * count();
  return pattern;
}

// The slacks of a stage's soft rows are the stage's.
Stages WithSoftRows::stages() const {
  Stages stages = problem_.stages();
  const auto first_from = [&](int row) {
    return static_cast<int>(std::ranges::lower_bound(soft_, row, {}, &SoftRow::row) - soft_.begin());
  };
  for (auto& [variables, rows, slacks] : stages.stages) slacks = {excess(first_from(rows.begin)), excess(first_from(rows.end))};
  return stages;
}

// H = [ H_c  0             ]
//     [ 0    sigma diag(q) ]
SparsePattern WithSoftRows::hessian_pattern() const {
  SparsePattern pattern = problem_.hessian_pattern();
  for (int k = 0; k < 2 * count(); ++k) {
    pattern.inner.push_back(n_ + k);
    pattern.outer.push_back(pattern.nonzeros());
  }
  pattern.rows += 2 * count();
  pattern.cols += 2 * count();
  return pattern;
}

void WithSoftRows::bounds(Bounds& bounds) const {
  const Bounds inner = bounds_of(problem_);
  bounds.x_lower.head(n_) = inner.x_lower;
  bounds.x_upper.head(n_) = inner.x_upper;
  bounds.c_lower = inner.c_lower;
  bounds.c_upper = inner.c_upper;
  bounds.compliance = inner.compliance;
  bounds.preload = inner.preload;
  bounds.x_lower.tail(2 * count()).setZero();
  for (int k = 0; k < count(); ++k) {
    const int j = soft_[std::size_t(k)].row;
    if (std::isinf(inner.c_upper[j])) bounds.x_upper[excess(k)] = 0;
    if (std::isinf(inner.c_lower[j])) bounds.x_upper[shortfall(k)] = 0;
  }
}

/// A slack is as large as its row.
void WithSoftRows::nominal_values(VectorRef variables, VectorRef rows) const {
  problem_.nominal_values(variables.head(n_), rows);
  for (int k = 0; k < count(); ++k) variables[excess(k)] = variables[shortfall(k)] = rows[soft_[std::size_t(k)].row];
}

void WithSoftRows::initial_point(VectorRef x) const {
  problem_.initial_point(x.head(n_));
  x.tail(2 * count()).setZero();
}

double WithSoftRows::objective(ConstVectorRef x, Workspace& workspace) const {
  return problem_.objective(x.head(n_), workspace) + price(x);
}

void WithSoftRows::gradient(ConstVectorRef x, Workspace& workspace, VectorRef gradient) const {
  problem_.gradient(x.head(n_), workspace, gradient.head(n_));
  gradient.tail(2 * count()) = linear_ + x.tail(2 * count()).cwiseProduct(quadratic_);
}

void WithSoftRows::constraints(ConstVectorRef x, Workspace& workspace, VectorRef values) const {
  problem_.constraints(x.head(n_), workspace, values);
  for (int k = 0; k < count(); ++k) values[soft_[std::size_t(k)].row] += x[shortfall(k)] - x[excess(k)];
}

void WithSoftRows::jacobian(ConstVectorRef x, Workspace& workspace, std::span<double> values) const {
  const std::size_t inner = values.size() - 2 * soft_.size();
  problem_.jacobian(x.head(n_), workspace, values.first(inner));
  for (std::size_t k = inner; k < values.size(); k += 2) values[k] = -1, values[k + 1] = 1;
}

void WithSoftRows::hessian(ConstVectorRef x, double sigma, ConstVectorRef lambda, Workspace& workspace, std::span<double> values) const {
  const std::size_t inner = values.size() - 2 * soft_.size();
  problem_.hessian(x.head(n_), sigma, lambda, workspace, values.first(inner));
  for (int k = 0; k < 2 * count(); ++k) values[inner + std::size_t(k)] = sigma * quadratic_[k];
}

std::string WithSoftRows::variable_name(int i) const {
  if (i < n_) return problem_.variable_name(i);
  const int k = i - n_;
  return (k % 2 == 0 ? "excess of " : "shortfall of ") + problem_.constraint_name(soft_[std::size_t(k / 2)].row);
}

}  // namespace tenon
