#include "tenon/core/with_slacks.hpp"

#include <algorithm>
#include <stdexcept>

#include "tenon/core/solver.hpp"

namespace tenon {

namespace {

Bounds bounds_of(const Nlp& problem) {
  Bounds bounds(problem.num_variables(), problem.num_constraints());
  problem.bounds(bounds);
  return bounds;
}

}  // namespace

bool has_compliant_rows(const Nlp& problem) { return (bounds_of(problem).compliance.array() > 0).any(); }

WithSlacks::WithSlacks(const Nlp& problem) : problem_(problem), n_(problem.num_variables()), m_(problem.num_constraints()) {
  const Bounds bounds = bounds_of(problem);
  for (int j = 0; j < m_; ++j) {
    if (bounds.compliance[j] > 0) rows_.push_back(j);
  }
  stiffness_.setZero(num_slacks());
  preload_.setZero(num_slacks());
  update();
}

void WithSlacks::update() {
  const Bounds bounds = bounds_of(problem_);
  validate(problem_, bounds);
  for (int j = 0; j < m_; ++j) {
    if (bounds.compliance[j] > 0 && !std::binary_search(rows_.begin(), rows_.end(), j)) {
      throw std::invalid_argument("row " + problem_.constraint_name(j) + " of " + problem_.name() +
                                  " has become compliant after its solver was made (expected the same compliant rows, or fewer)");
    }
  }
  for (int k = 0; k < num_slacks(); ++k) {
    const double compliance = bounds.compliance[rows_[k]];
    stiffness_[k] = compliance > 0 ? 1 / compliance : 0;
    preload_[k] = bounds.preload[rows_[k]];
  }
}

Point WithSlacks::lift(const Point& point) const {
  Point lifted(num_variables(), m_);
  lifted.x.head(n_) = point.x;
  lifted.z.head(n_) = point.z;
  lifted.lambda = point.lambda;
  for (int k = 0; k < num_slacks(); ++k) {
    lifted.x[n_ + k] = stiffness_[k] > 0 ? (point.lambda[rows_[k]] - preload_[k]) / stiffness_[k] : 0;
  }
  return lifted;
}

void WithSlacks::lower(const Point& lifted, Point& point) const {
  point.x = lifted.x.head(n_);
  point.z = lifted.z.head(n_);
  point.lambda = lifted.lambda;
}

// J = [ J_c  -E ],  E: one unit column for each slack
SparsePattern WithSlacks::jacobian_pattern() const {
  SparsePattern pattern = problem_.jacobian_pattern();
  pattern.cols += num_slacks();
  for (const int row : rows_) {
    pattern.inner.push_back(row);
    pattern.outer.push_back(pattern.nonzeros());
  }
  return pattern;
}

// H = [ H_c  0             ]
//     [ 0    sigma D^-1    ]
SparsePattern WithSlacks::hessian_pattern() const {
  SparsePattern pattern = problem_.hessian_pattern();
  for (int k = 0; k < num_slacks(); ++k) {
    pattern.inner.push_back(n_ + k);
    pattern.outer.push_back(pattern.nonzeros());
  }
  pattern.rows += num_slacks();
  pattern.cols += num_slacks();
  return pattern;
}

void WithSlacks::bounds(Bounds& bounds) const {
  const Bounds inner = bounds_of(problem_);
  bounds.x_lower.head(n_) = inner.x_lower;
  bounds.x_upper.head(n_) = inner.x_upper;
  bounds.c_lower = inner.c_lower;
  bounds.c_upper = inner.c_upper;
  for (int k = 0; k < num_slacks(); ++k) {
    if (stiffness_[k] == 0) bounds.x_lower[n_ + k] = bounds.x_upper[n_ + k] = 0;
  }
}

void WithSlacks::initial_point(VectorRef x) const {
  problem_.initial_point(x.head(n_));
  x.tail(num_slacks()).setZero();
}

double WithSlacks::objective(ConstVectorRef x, Workspace& workspace) const {
  const auto e = x.tail(num_slacks());
  return problem_.objective(x.head(n_), workspace) + 0.5 * e.cwiseAbs2().dot(stiffness_) + e.dot(preload_);
}

void WithSlacks::gradient(ConstVectorRef x, Workspace& workspace, VectorRef gradient) const {
  problem_.gradient(x.head(n_), workspace, gradient.head(n_));
  gradient.tail(num_slacks()) = x.tail(num_slacks()).cwiseProduct(stiffness_) + preload_;
}

void WithSlacks::constraints(ConstVectorRef x, Workspace& workspace, VectorRef values) const {
  problem_.constraints(x.head(n_), workspace, values);
  for (int k = 0; k < num_slacks(); ++k) values[rows_[k]] -= x[n_ + k];
}

void WithSlacks::jacobian(ConstVectorRef x, Workspace& workspace, std::span<double> values) const {
  const std::size_t inner = values.size() - rows_.size();
  problem_.jacobian(x.head(n_), workspace, values.first(inner));
  std::fill(values.begin() + static_cast<std::ptrdiff_t>(inner), values.end(), -1.0);
}

void WithSlacks::hessian(ConstVectorRef x, double sigma, ConstVectorRef lambda, Workspace& workspace, std::span<double> values) const {
  const std::size_t inner = values.size() - rows_.size();
  problem_.hessian(x.head(n_), sigma, lambda, workspace, values.first(inner));
  for (int k = 0; k < num_slacks(); ++k) values[inner + static_cast<std::size_t>(k)] = sigma * stiffness_[k];
}

std::string WithSlacks::variable_name(int i) const {
  return i < n_ ? problem_.variable_name(i) : "slack of " + problem_.constraint_name(rows_[static_cast<std::size_t>(i - n_)]);
}

}  // namespace tenon
