// Automatic<User>: a small dense problem whose objective and rows are written once, as templates; its derivatives are exact.
//
//     struct Rosenbrock {
//       static constexpr int kVariables = 2, kConstraints = 1;
//       template <class T> T objective(const std::array<T, 2>& x) const { return 100 * square(x[1] - square(x[0])) + square(1 - x[0]); }
//       template <class T> void constraints(const std::array<T, 2>& x, std::array<T, 1>& c) const { c[0] = x[0] * x[1]; }
//       void bounds(tenon::BasicBounds<double, 2, 1>& bounds) const { bounds.c_lower[0] = 1; }
//       void initial_point(Eigen::Vector2d& x) const { x << -2, 1; }                              // optional
//     };
//
// The functions see double, and tenon::SecondOrder<double, N> (second_order.hpp): + - * /, comparisons, and sin cos tan atan tanh exp log
// sqrt pow square abs, to be called without std::. The cost of all derivatives grows with N^2 (automatic.md): meant for N up to some 20.
// The pieces of a large sparse problem (one interval of a transcription) are differentiated one at a time by `Derivatives`.
#pragma once

#include <array>
#include <string>
#include <utility>

#include "tenon/core/nlp.hpp"
#include "tenon/core/second_order.hpp"

namespace tenon {

/// The square of a number, so that formulas may say it of either kind.
inline double square(double x) {
  return x * x;
}

/// Values, Jacobian, and what the Hessian of any combination of M functions of N variables is made of.
template <int N, int M>
class Derivatives {
 public:
  using Number = SecondOrder<double, N>;

  /// f(x, y): takes std::array<T, N>, writes std::array<T, M>.
  template <class Functions>
  void evaluate(Functions&& f, const double* x) {
    std::array<Number, N> variables;
    for (int i = 0; i < N; ++i) variables[std::size_t(i)] = Number::variable(i, x[i]);
    f(std::as_const(variables), y_);
  }

  double value(int row) const { return y_[std::size_t(row)].value(); }
  double jacobian(int row, int i) const { return y_[std::size_t(row)].derivative(i); }

  /// hess sum weights_k y_k: entry (i, j) is Number::hessian(of this, i, j).
  typename Number::Along combine(const double* weights) const {
    typename Number::Along sum = Number::Along::Zero();
    for (int k = 0; k < M; ++k) sum += weights[k] * y_[std::size_t(k)].second();
    return sum;
  }

 private:
  std::array<Number, std::size_t(M)> y_;
};

template <class User>
class Automatic {
 public:
  using Scalar = double;
  static constexpr int kVariables = User::kVariables;
  static constexpr int kConstraints = User::kConstraints;
  using VectorN = Eigen::Matrix<double, kVariables, 1>;
  using VectorM = Eigen::Matrix<double, kConstraints, 1>;

  /// At one x: all derivatives, made when the first of them is asked for.
  struct Workspace {
    Derivatives<kVariables, 1 + kConstraints> derivatives;  // of the objective, then of the rows
    bool is_differentiated = false;
  };

  explicit Automatic(User user = {}) : user_(std::move(user)) {}

  /// What moves between solves is the user's own.
  User& user() { return user_; }

  constexpr int num_variables() const { return kVariables; }
  constexpr int num_constraints() const { return kConstraints; }
  Workspace make_workspace() const { return {}; }
  void bounds(BasicBounds<double, kVariables, kConstraints>& bounds) const {
    if constexpr (requires { user_.bounds(bounds); }) user_.bounds(bounds);
  }
  void initial_point(VectorN& x) const {
    if constexpr (requires { user_.initial_point(x); })
      user_.initial_point(x);
    else
      x.setZero();
  }
  std::string name() const {
    if constexpr (requires { user_.name(); })
      return user_.name();
    else
      return "problem";
  }

  void prepare(const VectorN&, Workspace& at) const { at.is_differentiated = false; }

  double objective(const VectorN& x, Workspace&) const { return user_.objective(array_of(x)); }

  void constraints(const VectorN& x, Workspace&, VectorM& values) const {
    std::array<double, std::size_t(kConstraints)> rows;
    if constexpr (kConstraints > 0) user_.constraints(array_of(x), rows);
    for (int j = 0; j < kConstraints; ++j) values[j] = rows[std::size_t(j)];
  }

  void gradient(const VectorN& x, Workspace& at, VectorN& gradient) const {
    differentiate(x, at);
    for (int i = 0; i < kVariables; ++i) gradient[i] = at.derivatives.jacobian(0, i);
  }

  void jacobian(const VectorN& x, Workspace& at, Eigen::Matrix<double, kConstraints, kVariables>& jacobian) const {
    differentiate(x, at);
    for (int j = 0; j < kConstraints; ++j) {
      for (int i = 0; i < kVariables; ++i) jacobian(j, i) = at.derivatives.jacobian(1 + j, i);
    }
  }

  void hessian(const VectorN& x, double sigma, const VectorM& lambda, Workspace& at,
               Eigen::Matrix<double, kVariables, kVariables>& hessian) const {
    differentiate(x, at);
    Eigen::Matrix<double, 1 + kConstraints, 1> weights;
    weights << sigma, lambda;
    const auto combined = at.derivatives.combine(weights.data());
    for (int j = 0; j < kVariables; ++j) {
      for (int i = j; i < kVariables; ++i) hessian(i, j) = decltype(at.derivatives)::Number::hessian(combined, i, j);
    }
  }

 private:
  static std::array<double, std::size_t(kVariables)> array_of(const VectorN& x) {
    std::array<double, std::size_t(kVariables)> array;
    for (int i = 0; i < kVariables; ++i) array[std::size_t(i)] = x[i];
    return array;
  }

  void differentiate(const VectorN& x, Workspace& at) const {
    if (at.is_differentiated) return;
    at.derivatives.evaluate(
        [this](const auto& variables, auto& values) {
          using T = std::decay_t<decltype(values[0])>;
          values[0] = user_.objective(variables);
          if constexpr (kConstraints > 0) {
            std::array<T, std::size_t(kConstraints)> rows;
            user_.constraints(variables, rows);
            for (std::size_t j = 0; j < rows.size(); ++j) values[1 + j] = rows[j];
          }
        },
        x.data());
    at.is_differentiated = true;
  }

  User user_;
};

}  // namespace tenon
