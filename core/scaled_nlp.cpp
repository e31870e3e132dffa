#include "tenon/core/scaled_nlp.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace tenon {

namespace {

constexpr double kLargestDerivative = 10;  // g
constexpr double kSmallestFactor = 1e-8;

double power_of_two_below(double value) {
  return std::ldexp(1.0, std::ilogb(value));
}

double factor_for(double largest_derivative) {
  if (!std::isfinite(largest_derivative) || largest_derivative <= kLargestDerivative) return 1;
  return power_of_two_below(std::max(kSmallestFactor, kLargestDerivative / largest_derivative));
}

void check_nominal(const std::string& name, double value) {
  if (!(value >= 0) || std::isinf(value)) {
    throw std::invalid_argument("the nominal value of " + name + " is " + std::to_string(value) +
                                " (expected > 0 and finite, or 0: not stated)");
  }
}

}  // namespace

ScaledNlp::ScaledNlp(const Nlp& problem)
    : NlpDecorator(problem), jacobian_pattern_(problem.jacobian_pattern()), hessian_pattern_(problem.hessian_pattern()) {
  const int n = num_variables(), m = num_constraints();
  dx_.setZero(n);
  dc_.setZero(m);
  largest_.setZero(m);
  elsewhere_.setZero(m);
  problem.nominal_values(dx_, dc_);
  for (int i = 0; i < n; ++i) {
    check_nominal(variable_name(i), dx_[i]);
    dx_[i] = dx_[i] > 0 ? power_of_two_below(dx_[i]) : 1;
  }
  for (int j = 0; j < m; ++j) {
    check_nominal(constraint_name(j), dc_[j]);
    stated_.push_back(dc_[j] > 0);
    dc_[j] = stated_.back() ? power_of_two_below(1 / dc_[j]) : 1;
  }
  jacobian_.resize(jacobian_pattern_.nonzeros());
  hessian_.resize(hessian_pattern_.nonzeros());
  update_entries();
}

void ScaledNlp::choose(const Vector& gradient, std::span<const double> jacobian) {
  s_ = gradient.size() == 0 ? 1 : factor_for(gradient.cwiseProduct(dx_).lpNorm<Eigen::Infinity>());
  measure_rows(jacobian, largest_);
  for (Eigen::Index j = 0; j < dc_.size(); ++j) {
    if (!stated_[std::size_t(j)]) dc_[j] = factor_for(largest_[j]);
  }
  update_entries();
}

bool ScaledNlp::has_flat_rows() const {
  return (largest_.array() == 0).any();
}

void ScaledNlp::choose_flat_rows(std::span<const double> jacobian) {
  measure_rows(jacobian, elsewhere_);
  for (Eigen::Index j = 0; j < dc_.size(); ++j) {
    if (!stated_[std::size_t(j)] && largest_[j] == 0) dc_[j] = factor_for(elsewhere_[j]);
  }
  update_entries();
}

void ScaledNlp::measure_rows(std::span<const double> jacobian, Vector& largest) const {
  largest.setZero();
  const SparsePattern& p = jacobian_pattern_;
  for (int j = 0; j < p.cols; ++j) {
    for (auto k = static_cast<std::size_t>(p.outer[std::size_t(j)]); k < static_cast<std::size_t>(p.outer[std::size_t(j) + 1]); ++k) {
      double& most = largest[p.inner[k]];
      most = std::isfinite(jacobian[k]) ? std::max(most, std::abs(jacobian[k]) * dx_[j]) : kInfinity<double>;
    }
  }
}

void ScaledNlp::update_entries() {
  const auto fill = [this](const SparsePattern& p, const Vector& rows, Vector& factors) {
    for (int j = 0; j < p.cols; ++j) {
      for (int k = p.outer[std::size_t(j)]; k < p.outer[std::size_t(j) + 1]; ++k) factors[k] = rows[p.inner[std::size_t(k)]] * dx_[j];
    }
  };
  fill(jacobian_pattern_, dc_, jacobian_);
  fill(hessian_pattern_, dx_, hessian_);
  identity_ = s_ == 1 && (dx_.array() == 1).all() && (dc_.array() == 1).all();
}

double ScaledNlp::smallest_factor() const {
  return dc_.size() == 0 ? s_ : std::min(s_, dc_.minCoeff());
}

void ScaledNlp::scale(Point& point) const {
  point.x.array() /= dx_.array();
  point.lambda.array() *= s_ / dc_.array();
  point.z.array() *= s_ * dx_.array();
}

void ScaledNlp::unscale(Point& point) const {
  point.x.array() *= dx_.array();
  point.lambda.array() *= dc_.array() / s_;
  point.z.array() /= s_ * dx_.array();
}

// e^ = d_c e = d_c D (d_c lambda^ / s - preload):   D^ = d_c^2 D / s,   preload^ = s preload / d_c
void ScaledNlp::bounds(Bounds& bounds) const {
  problem_.bounds(bounds);
  bounds.x_lower.array() /= dx_.array();
  bounds.x_upper.array() /= dx_.array();
  bounds.c_lower.array() *= dc_.array();
  bounds.c_upper.array() *= dc_.array();
  bounds.compliance.array() *= dc_.array().square() / s_;
  bounds.preload.array() *= s_ / dc_.array();
}

void ScaledNlp::initial_point(VectorRef x) const {
  problem_.initial_point(x);
  x.array() /= dx_.array();
}

Nlp::Workspace ScaledNlp::make_workspace() const {
  auto made = std::make_unique<ScaledScratch>();
  made->problem = problem_.make_workspace();
  made->x.resize(num_variables());
  made->lambda.resize(num_constraints());
  return made;
}

void ScaledNlp::prepare(ConstVectorRef x, Workspace& workspace) const {
  ScaledScratch& at = scaled(workspace);
  at.x = x.cwiseProduct(dx_);
  problem_.prepare(at.x, at.problem);
}

double ScaledNlp::objective(ConstVectorRef, Workspace& workspace) const {
  ScaledScratch& at = scaled(workspace);
  return s_ * problem_.objective(at.x, at.problem);
}

void ScaledNlp::gradient(ConstVectorRef, Workspace& workspace, VectorRef gradient) const {
  ScaledScratch& at = scaled(workspace);
  problem_.gradient(at.x, at.problem, gradient);
  gradient.array() *= s_ * dx_.array();
}

void ScaledNlp::constraints(ConstVectorRef, Workspace& workspace, VectorRef values) const {
  ScaledScratch& at = scaled(workspace);
  problem_.constraints(at.x, at.problem, values);
  values.array() *= dc_.array();
}

void ScaledNlp::jacobian(ConstVectorRef, Workspace& workspace, std::span<double> values) const {
  ScaledScratch& at = scaled(workspace);
  problem_.jacobian(at.x, at.problem, values);
  Eigen::Map<Eigen::ArrayXd>(values.data(), jacobian_.size()) *= jacobian_.array();
}

// hess (sigma f^ + lambda^' c^) = d_x [ sigma s hess f + sum (d_c lambda^)_j hess c_j ] d_x
void ScaledNlp::hessian(ConstVectorRef, double sigma, ConstVectorRef lambda, Workspace& workspace, std::span<double> values) const {
  ScaledScratch& at = scaled(workspace);
  at.lambda = lambda.cwiseProduct(dc_);
  problem_.hessian(at.x, sigma * s_, at.lambda, at.problem, values);
  Eigen::Map<Eigen::ArrayXd>(values.data(), hessian_.size()) *= hessian_.array();
}

}  // namespace tenon
