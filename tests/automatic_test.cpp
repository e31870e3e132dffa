// Automatic derivatives: exact for every function there is, for a whole problem written once, and for one interval of a cart-pole.
#include "tenon/core/automatic.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tenon/core/as_nlp.hpp"
#include "tenon/core/check_derivatives.hpp"
#include "tenon/solvers/make_solver.hpp"
#include "tenon/solvers/newton_kkt/newton_kkt.hpp"

namespace tenon {
namespace {

/// hs071, as its collection states it.
struct ProductAndSphere {
  static constexpr int kVariables = 4, kConstraints = 2;
  template <class T>
  T objective(const std::array<T, 4>& x) const {
    return x[0] * x[3] * (x[0] + x[1] + x[2]) + x[2];
  }
  template <class T>
  void constraints(const std::array<T, 4>& x, std::array<T, 2>& c) const {
    c[0] = x[0] * x[1] * x[2] * x[3];
    c[1] = square(x[0]) + square(x[1]) + square(x[2]) + square(x[3]);
  }
  void bounds(BasicBounds<double, 4, 2>& bounds) const {
    bounds.x_lower.setConstant(1);
    bounds.x_upper.setConstant(5);
    bounds.c_lower << 25, 40;
    bounds.c_upper[1] = 40;
  }
  void initial_point(Eigen::Vector4d& x) const { x << 1, 5, 5, 1; }
};
static_assert(NonlinearProgram<Automatic<ProductAndSphere>>);

/// Every function and operator, in one row each; no constraint on where they are evaluated but 0.2 < x < 1.2.
struct EveryFunction {
  static constexpr int kVariables = 3, kConstraints = 14;
  template <class T>
  T objective(const std::array<T, 3>& x) const {
    using std::sin;
    return sin(x[0] * x[1]) / (2 + x[2]);
  }
  template <class T>
  void constraints(const std::array<T, 3>& x, std::array<T, 14>& c) const {
    using std::sin, std::cos, std::tan, std::atan, std::tanh, std::exp, std::log, std::sqrt, std::pow, std::abs;
    const T u = x[0] + 0.3 * x[1] * x[2];
    c = {sin(u), cos(u), tan(u), atan(u), tanh(u), exp(u), log(u), sqrt(u), pow(u, 2.7), abs(-u), square(u), 1 / u, x[0] / (x[1] + x[2]),
         T(3)};
    c[13] -= u;
    c[13] *= x[2];
    c[13] /= 2 - x[0] / 4;
    c[13] += (u < 5 ? -x[1] : x[0]) - 1.5 + (2.5 - x[2] * 2);
  }
};

/// One interval of a swing-up: four states and an input through a Runge-Kutta step of a pole on a cart.
struct CartPoleStep {
  static constexpr int kVariables = 5, kConstraints = 4;
  template <class T>
  std::array<T, 4> rate(const std::array<T, 4>& y, const T& u) const {
    using std::sin, std::cos;
    constexpr double kCart = 5, kPole = 0.5, kLength = 0.5, kGravity = 9.806;
    const T s = sin(y[1]), c = cos(y[1]);
    const T a = (u + kPole * kLength * square(y[3]) * s + kPole * kGravity * c * s) / (kCart + kPole * square(s));
    return {y[2], y[3], a, -(a * c + kGravity * s) / kLength};
  }
  template <class T>
  T objective(const std::array<T, 5>& x) const {
    return 0.01 * square(x[4]);
  }
  template <class T>
  void constraints(const std::array<T, 5>& x, std::array<T, 4>& end) const {
    constexpr double kStep = 0.05;
    const std::array<T, 4> start{x[0], x[1], x[2], x[3]};
    const auto ahead = [&](double h, const std::array<T, 4>& k) {
      return std::array<T, 4>{start[0] + h * k[0], start[1] + h * k[1], start[2] + h * k[2], start[3] + h * k[3]};
    };
    const auto k1 = rate(start, x[4]), k2 = rate(ahead(kStep / 2, k1), x[4]), k3 = rate(ahead(kStep / 2, k2), x[4]),
               k4 = rate(ahead(kStep, k3), x[4]);
    for (std::size_t i = 0; i < 4; ++i) end[i] = start[i] + kStep / 6 * (k1[i] + 2 * (k2[i] + k3[i]) + k4[i]);
  }
};

template <class User>
void expect_exact(double low, double high) {
  const Automatic<User> problem;
  const AsNlp nlp(problem);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(low, high);
  std::normal_distribution<double> normal;
  for (int round = 0; round < 10; ++round) {
    Vector x(nlp.num_variables()), lambda(nlp.num_constraints());
    for (double& v : x) v = uniform(random);
    for (double& v : lambda) v = normal(random);
    const DerivativeReport report = check_derivatives(nlp, x, 0.7, lambda);
    EXPECT_TRUE(report.passed(1e-7)) << report.gradient_error << " " << report.jacobian_error << " " << report.hessian_error << " "
                                     << (report.worst.empty() ? "" : report.worst[0].what + report.worst[0].row);
  }
}

TEST(Automatic, EveryFunctionObeysTheDerivativeLaw) {
  expect_exact<EveryFunction>(0.2, 1.2);
}
TEST(Automatic, AWholeProblemObeysTheDerivativeLaw) {
  expect_exact<ProductAndSphere>(1, 5);
}
TEST(Automatic, AnIntervalOfACartPoleObeysTheDerivativeLaw) {
  expect_exact<CartPoleStep>(-2, 2);
}

TEST(Automatic, DerivativesAreThoseByHandToRounding) {
  const Automatic<ProductAndSphere> problem;
  auto at = problem.make_workspace();
  const Eigen::Vector4d x(1.2, 3.4, 2.6, 4.1);
  const Eigen::Vector2d lambda(0.7, -1.3);
  problem.prepare(x, at);
  Eigen::Vector4d gradient;
  Eigen::Matrix<double, 2, 4> jacobian;
  Eigen::Matrix4d hessian;
  problem.gradient(x, at, gradient);
  problem.jacobian(x, at, jacobian);
  problem.hessian(x, 0.5, lambda, at, hessian);
  EXPECT_NEAR(gradient[0], x[3] * (2 * x[0] + x[1] + x[2]), 1e-12);
  EXPECT_NEAR(jacobian(0, 1), x[0] * x[2] * x[3], 1e-12);
  EXPECT_NEAR(hessian(0, 0), 0.5 * 2 * x[3] - 2.6, 1e-12);
  EXPECT_NEAR(hessian(3, 0), 0.5 * (2 * x[0] + x[1] + x[2]) + 0.7 * x[1] * x[2], 1e-12);
  EXPECT_NEAR(hessian(2, 1), 0.7 * x[0] * x[3], 1e-12);
}

TEST(Automatic, IsSolvedAtFixedSizeAndByEveryBackEnd) {
  const Automatic<ProductAndSphere> problem;
  NewtonKkt solver(problem);
  PointOf<Automatic<ProductAndSphere>> point;
  problem.initial_point(point.x);
  EXPECT_EQ(solver.solve(point).status, Status::solved);
  EXPECT_NEAR(point.x[1], 4.7429994, 1e-6);
  const AsNlp nlp(problem);
  Point sparse(4, 2);
  nlp.initial_point(sparse.x);
  EXPECT_EQ(make_solver("newton-kkt", nlp)->solve(sparse).status, Status::solved);
  EXPECT_NEAR(sparse.lambda[0], -0.5522937, 1e-6);
}

}  // namespace
}  // namespace tenon
