#include "tenon/problems/classic/polynomial.hpp"

#include <stdexcept>

namespace tenon {

namespace {

Polynomial::Powers product(const Polynomial::Powers& a, const Polynomial::Powers& b) {
  std::map<int, int> sum(a.begin(), a.end());
  for (const auto& [variable, exponent] : b) sum[variable] += exponent;
  return {sum.begin(), sum.end()};
}

double integer_power(double base, int exponent) {
  double result = 1;
  for (int k = 0; k < exponent; ++k) result *= base;
  return result;
}

}  // namespace

Polynomial::Polynomial(double constant) { add({}, constant); }

Polynomial Polynomial::variable(int i) {
  Polynomial x;
  x.add({{i, 1}}, 1);
  return x;
}

void Polynomial::add(const Powers& powers, double coefficient) {
  const double sum = terms_[powers] += coefficient;
  if (sum == 0) terms_.erase(powers);
}

Polynomial& Polynomial::operator+=(const Polynomial& other) {
  for (const auto& [powers, coefficient] : other.terms_) add(powers, coefficient);
  return *this;
}

Polynomial operator*(const Polynomial& a, const Polynomial& b) {
  Polynomial result;
  for (const auto& [left, a_coefficient] : a.terms_) {
    for (const auto& [right, b_coefficient] : b.terms_) result.add(product(left, right), a_coefficient * b_coefficient);
  }
  return result;
}

Polynomial power(const Polynomial& base, int exponent) {
  Polynomial result = 1;
  for (int k = 0; k < exponent; ++k) result = result * base;
  return result;
}

std::vector<Polynomial> polynomial_variables(int n) {
  std::vector<Polynomial> x;
  for (int i = 0; i < n; ++i) x.push_back(Polynomial::variable(i));
  return x;
}

double Polynomial::operator()(ConstVectorRef x) const {
  double sum = 0;
  for (const auto& [powers, coefficient] : terms_) {
    double term = coefficient;
    for (const auto& [variable, exponent] : powers) term *= integer_power(x[variable], exponent);
    sum += term;
  }
  return sum;
}

Polynomial Polynomial::derivative(int i) const {
  Polynomial result;
  for (const auto& [powers, coefficient] : terms_) {
    Powers lowered;
    int exponent_of_i = 0;
    for (const auto& [variable, exponent] : powers) {
      if (variable == i) exponent_of_i = exponent;
      const int left = variable == i ? exponent - 1 : exponent;
      if (left > 0) lowered.emplace_back(variable, left);
    }
    if (exponent_of_i > 0) result.add(lowered, coefficient * exponent_of_i);
  }
  return result;
}

PolynomialNlp::PolynomialNlp(PolynomialProgram program) : program_(std::move(program)) {
  const int n = num_variables(), m = num_constraints();
  for (const Vector* bound : {&program_.x_lower, &program_.x_upper}) {
    if (bound->size() != 0 && bound->size() != n) {
      throw std::invalid_argument(program_.name + ": bounds have " + std::to_string(bound->size()) + " entries (expected " +
                                  std::to_string(n) + ", or none)");
    }
  }
  jacobian_pattern_ = {m, n, {0}, {}};
  hessian_pattern_ = {n, n, {0}, {}};
  for (int j = 0; j < n; ++j) {
    gradient_.push_back(program_.objective.derivative(j));
    std::vector<Polynomial> column;  // d c_r / dx_j, then d f / dx_j
    for (int r = 0; r < m; ++r) {
      column.push_back(program_.rows[static_cast<std::size_t>(r)].value.derivative(j));
      if (column.back().is_zero()) continue;
      jacobian_pattern_.inner.push_back(r);
      jacobian_.push_back(column.back());
    }
    column.push_back(gradient_.back());

    for (int i = j; i < n; ++i) {
      std::vector<Curvature> entry;
      for (int r = 0; r <= m; ++r) {
        Polynomial second = column[static_cast<std::size_t>(r)].derivative(i);
        if (!second.is_zero()) entry.push_back({r == m ? -1 : r, std::move(second)});
      }
      if (entry.empty()) continue;
      hessian_pattern_.inner.push_back(i);
      hessian_.push_back(std::move(entry));
    }
    jacobian_pattern_.outer.push_back(jacobian_pattern_.nonzeros());
    hessian_pattern_.outer.push_back(hessian_pattern_.nonzeros());
  }
}

void PolynomialNlp::bounds(Bounds& bounds) const {
  if (program_.x_lower.size() != 0) bounds.x_lower = program_.x_lower;
  if (program_.x_upper.size() != 0) bounds.x_upper = program_.x_upper;
  for (int r = 0; r < num_constraints(); ++r) {
    bounds.c_lower[r] = program_.rows[static_cast<std::size_t>(r)].lower;
    bounds.c_upper[r] = program_.rows[static_cast<std::size_t>(r)].upper;
  }
}

double PolynomialNlp::objective(ConstVectorRef x, Workspace&) const { return program_.objective(x); }

void PolynomialNlp::gradient(ConstVectorRef x, Workspace&, VectorRef gradient) const {
  for (int j = 0; j < num_variables(); ++j) gradient[j] = gradient_[static_cast<std::size_t>(j)](x);
}

void PolynomialNlp::constraints(ConstVectorRef x, Workspace&, VectorRef values) const {
  for (int r = 0; r < num_constraints(); ++r) values[r] = program_.rows[static_cast<std::size_t>(r)].value(x);
}

void PolynomialNlp::jacobian(ConstVectorRef x, Workspace&, std::span<double> values) const {
  for (std::size_t k = 0; k < values.size(); ++k) values[k] = jacobian_[k](x);
}

void PolynomialNlp::hessian(ConstVectorRef x, double sigma, ConstVectorRef lambda, Workspace&, std::span<double> values) const {
  for (std::size_t k = 0; k < values.size(); ++k) {
    values[k] = 0;
    for (const Curvature& part : hessian_[k]) values[k] += (part.row < 0 ? sigma : lambda[part.row]) * part.value(x);
  }
}

}  // namespace tenon
