// Polynomials in x_0 .. x_{n-1}, written as formulas, differentiated by rule, and the nonlinear programs made of them.
//
//     const auto x = polynomial_variables(2);
//     const Polynomial f = 100 * square(x[1] - square(x[0])) + square(1 - x[0]);
//
// A polynomial is a sum of terms  a x_i^p x_j^q ... ; d/dx_i of a term is  (a p) x_i^(p-1) x_j^q ...
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tenon/core/nlp.hpp"

namespace tenon {

class Polynomial {
 public:
  /// The variables of one term with their powers (>= 1), ascending: x_0 x_3^2 is {{0, 1}, {3, 2}}. Empty for a constant.
  using Powers = std::vector<std::pair<int, int>>;

  Polynomial(double constant = 0);  // implicit, so that formulas mix numbers and variables
  static Polynomial variable(int i);

  Polynomial& operator+=(const Polynomial& other);
  friend Polynomial operator+(Polynomial a, const Polynomial& b) { return a += b; }
  friend Polynomial operator-(const Polynomial& a, const Polynomial& b) { return a + -1 * b; }
  friend Polynomial operator-(const Polynomial& a) { return -1 * a; }
  friend Polynomial operator*(const Polynomial& a, const Polynomial& b);

  double operator()(ConstVectorRef x) const;
  Polynomial derivative(int i) const;
  bool is_zero() const { return terms_.empty(); }

 private:
  void add(const Powers& powers, double coefficient);

  std::map<Powers, double> terms_;
};

Polynomial power(const Polynomial& base, int exponent);
inline Polynomial square(const Polynomial& base) { return base * base; }

/// x_0 .. x_{n-1}.
std::vector<Polynomial> polynomial_variables(int n);

/// What defines a polynomial program. Rows are given as polynomials with bounds.
struct PolynomialProgram {
  struct Row {
    Polynomial value;
    double lower, upper;
  };

  std::string name = {};
  Vector start = {};             // n
  Vector x_lower = {};           // n; empty where no variable has a lower bound
  Vector x_upper = {};           // n; empty where no variable has an upper one
  Polynomial objective = {};
  std::vector<Row> rows = {};
};

/// The two forms in which collections state their rows: value >= 0 and value = 0.
inline PolynomialProgram::Row at_least_zero(Polynomial value) { return {std::move(value), 0, kInfinity<double>}; }
inline PolynomialProgram::Row equals_zero(Polynomial value) { return {std::move(value), 0, 0}; }

class PolynomialNlp final : public Nlp {
 public:
  /// Differentiates everything once. Throws std::invalid_argument where start and bounds differ in length.
  explicit PolynomialNlp(PolynomialProgram program);

  int num_variables() const override { return static_cast<int>(program_.start.size()); }
  int num_constraints() const override { return static_cast<int>(program_.rows.size()); }
  SparsePattern jacobian_pattern() const override { return jacobian_pattern_; }
  SparsePattern hessian_pattern() const override { return hessian_pattern_; }
  void bounds(Bounds& bounds) const override;
  void initial_point(VectorRef x) const override { x = program_.start; }
  double objective(ConstVectorRef x, Workspace& workspace) const override;
  void gradient(ConstVectorRef x, Workspace& workspace, VectorRef gradient) const override;
  void constraints(ConstVectorRef x, Workspace& workspace, VectorRef values) const override;
  void jacobian(ConstVectorRef x, Workspace& workspace, std::span<double> values) const override;
  void hessian(ConstVectorRef x, double sigma, ConstVectorRef lambda, Workspace& workspace, std::span<double> values) const override;
  std::string name() const override { return program_.name; }

 private:
  /// d^2/dx_i dx_j of one function: row -1 is the objective.
  struct Curvature {
    int row;
    Polynomial value;
  };

  PolynomialProgram program_;
  std::vector<Polynomial> gradient_;
  SparsePattern jacobian_pattern_, hessian_pattern_;
  std::vector<Polynomial> jacobian_;             // one for each entry of the pattern
  std::vector<std::vector<Curvature>> hessian_;  // the functions that meet in each entry of the pattern
};

}  // namespace tenon
