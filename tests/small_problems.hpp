// Tiny problems that provoke one thing each.
#pragma once

#include <cmath>

#include "tenon/problems/classic/polynomial.hpp"

namespace tenon {

inline Vector vector(std::initializer_list<double> list) {
  return Eigen::Map<const Vector>(list.begin(), static_cast<Eigen::Index>(list.size()));
}

/// min (x0-2)^2 + (x1-1)^2  s.t.  x0 + x1 = 2,  x1 fixed at 0.5:  x0 = 1.5, lambda = 1, z1 = 0.
/// With the target of x1 at `target`: z1 = -(2 (0.5 - target) + lambda).
inline PolynomialNlp fixed_variable(double target) {
  const auto x = polynomial_variables(2);
  return PolynomialNlp({.name = "fixed_variable",
                        .start = vector({0, 0.5}),
                        .x_lower = vector({-kInfinity<double>, 0.5}),
                        .x_upper = vector({kInfinity<double>, 0.5}),
                        .objective = square(x[0] - 2) + square(x[1] - target),
                        .rows = {equals_zero(x[0] + x[1] - 2)}});
}

/// min x0 + x1  s.t.  x0^2 + x1^2 <= -1.
inline PolynomialNlp infeasible() {
  const auto x = polynomial_variables(2);
  return PolynomialNlp({.name = "infeasible",
                        .start = vector({1, 2}),
                        .objective = x[0] + x[1],
                        .rows = {at_least_zero(-1 - square(x[0]) - square(x[1]))}});
}

/// min -x0 - x1^2  s.t.  x0 >= 0.
inline PolynomialNlp unbounded() {
  const auto x = polynomial_variables(2);
  return PolynomialNlp({.name = "unbounded", .start = vector({1, 1}), .x_lower = Vector::Zero(2), .objective = -x[0] - square(x[1])});
}

/// min x - log x: not finite for x <= 0; solution x = 1.
class Logarithm final : public Nlp {
 public:
  explicit Logarithm(double start) : start_(start) {}
  int num_variables() const override { return 1; }
  int num_constraints() const override { return 0; }
  SparsePattern jacobian_pattern() const override { return SparsePattern::full(0, 1); }
  SparsePattern hessian_pattern() const override { return SparsePattern::full_lower(1); }
  void bounds(Bounds&) const override {}
  void initial_point(VectorRef x) const override { x[0] = start_; }
  double objective(ConstVectorRef x, Workspace&) const override { return x[0] - std::log(x[0]); }
  void gradient(ConstVectorRef x, Workspace&, VectorRef gradient) const override { gradient[0] = 1 - 1 / x[0]; }
  void constraints(ConstVectorRef, Workspace&, VectorRef) const override {}
  void jacobian(ConstVectorRef, Workspace&, std::span<double>) const override {}
  void hessian(ConstVectorRef x, double sigma, ConstVectorRef, Workspace&, std::span<double> values) const override {
    values[0] = sigma / (x[0] * x[0]);
  }

 private:
  double start_;
};

/// min 1/2 (x0^2 + x1^2)  s.t.  x0 + x1 - e >= 2,  e = D (lambda - preload). By hand, the row active:
/// x0 = x1 = -lambda,  -2 lambda - D (lambda - preload) = 2,  lambda = (D preload - 2) / (2 + D).
class CompliantRow final : public Nlp {
 public:
  double compliance = 0.5, preload = -0.1;

  int num_variables() const override { return 2; }
  int num_constraints() const override { return 1; }
  SparsePattern jacobian_pattern() const override { return SparsePattern::full(1, 2); }
  SparsePattern hessian_pattern() const override { return SparsePattern::from_entries(2, 2, {{0, 0}, {1, 1}}); }
  void bounds(Bounds& bounds) const override {
    bounds.c_lower[0] = 2;
    bounds.compliance[0] = compliance;
    bounds.preload[0] = preload;
  }
  double objective(ConstVectorRef x, Workspace&) const override { return 0.5 * x.squaredNorm(); }
  void gradient(ConstVectorRef x, Workspace&, VectorRef gradient) const override { gradient = x; }
  void constraints(ConstVectorRef x, Workspace&, VectorRef values) const override { values[0] = x.sum(); }
  void jacobian(ConstVectorRef, Workspace&, std::span<double> values) const override { values[0] = values[1] = 1; }
  void hessian(ConstVectorRef, double sigma, ConstVectorRef, Workspace&, std::span<double> values) const override {
    values[0] = values[1] = sigma;
  }
  std::string constraint_name(int) const override { return "spring"; }

  double expected_lambda() const { return (compliance * preload - 2) / (2 + compliance); }
};

}  // namespace tenon
