// Problems that give no Hessian: the approximation is positive definite, meets the last change of gradient, and solves the classics.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "small_problems.hpp"
#include "tenon/core/quasi_newton_nlp.hpp"
#include "tenon/problems/catalogue.hpp"
#include "tenon/solvers/make_solver.hpp"
#include "tenon/tests/solved.hpp"

namespace tenon {
namespace {

/// A problem that keeps its Hessian to itself.
class WithoutHessian final : public NlpDecorator {
 public:
  using NlpDecorator::NlpDecorator;
  HessianKind hessian_kind() const override { return HessianKind::none; }
  SparsePattern hessian_pattern() const override { return SparsePattern::from_entries(num_variables(), num_variables(), {}); }
  void hessian(ConstVectorRef, double, ConstVectorRef, Workspace&, std::span<double>) const override { FAIL() << "asked for a Hessian"; }
};

TEST(QuasiNewton, TheApproximationMeetsTheSecantEquationAndIsPositiveDefinite) {
  const auto problem = find_problem("hs071").make();
  const QuasiNewtonNlp approximate(*problem);
  Nlp::Workspace w = approximate.make_workspace();
  SparseMatrix lower = approximate.hessian_pattern().zero_matrix(), jacobian = problem->jacobian_pattern().zero_matrix();
  const Vector lambda = vector({-0.5, 0.2});
  Vector last_gradient(4), last_x;
  for (const Vector& x : {vector({1, 5, 5, 1}), vector({1.1, 4.8, 4.1, 1.3}), vector({1.2, 4.7, 3.9, 1.6})}) {
    approximate.prepare(x, w);
    approximate.hessian(x, 1, lambda, w, values_of(lower));
    const Eigen::MatrixXd B = Eigen::MatrixXd(lower).selfadjointView<Eigen::Lower>();
    EXPECT_GT(B.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), 0);
    Vector gradient(4);
    approximate.gradient(x, w, gradient);
    approximate.jacobian(x, w, values_of(jacobian));
    gradient += jacobian.transpose() * lambda;
    if (last_x.size() > 0) {
      const Vector s = x - last_x, y = gradient - last_gradient;
      EXPECT_GE(s.dot(B * s), 0.19 * s.dot(y)) << "curvature is learnt, damped at most";
      if (s.dot(y) > 0.5 * s.squaredNorm()) {
        EXPECT_LE((B * s - y).norm(), 1e-10 * y.norm());
      }
    }
    last_x = x, last_gradient = gradient;
  }
}

TEST(QuasiNewton, TheClassicsAreSolvedWithoutTheirHessians) {
  for (const CatalogueEntry& entry : catalogue()) {
    const auto problem = entry.make();
    if (problem->num_variables() > 50) continue;  // no classic: an optimal control problem, whose Hessian is not to be guessed densely
    const Solved exact = solve(*problem), approximate = solve(WithoutHessian(*problem), "newton-kkt", {.max_iterations = 500});
    EXPECT_TRUE(succeeded(approximate.result.status)) << entry.name << " " << to_string(approximate.result.status);
    EXPECT_LE(approximate.result.iterations, 100) << entry.name;
    if (entry.name == "hs044") continue;  // several local optima
    EXPECT_NEAR(approximate.result.objective, exact.result.objective, 1e-5 * std::max(1.0, std::abs(exact.result.objective))) << entry.name;
  }
}

TEST(QuasiNewton, IpoptKeepsItsOwn) {
  for (const SolverDescription& solver : list_solvers()) {
    if (solver.name == "ipopt" && !solver.available) GTEST_SKIP();
  }
  const auto problem = find_problem("hs071").make();
  const Solved solved = solve(WithoutHessian(*problem), "ipopt");
  EXPECT_TRUE(succeeded(solved.result.status)) << to_string(solved.result.status);
  EXPECT_NEAR(solved.result.objective, 17.0140173, 1e-6);
}

TEST(QuasiNewton, TwoSolvesOfOneSolverAgreeBitwise) {
  const auto inner = find_problem("hs100").make();
  const WithoutHessian problem(*inner);
  const auto solver = make_solver("newton-kkt", problem);
  Point first(7, 4), second(7, 4);
  problem.initial_point(first.x);
  problem.initial_point(second.x);
  EXPECT_EQ(solver->solve(first).iterations, solver->solve(second).iterations);
  EXPECT_EQ(first.x, second.x);
}

TEST(QuasiNewton, TooManyVariablesAreAnErrorThatSaysSo) {
  class Many final : public NlpDecorator {
   public:
    using NlpDecorator::NlpDecorator;
    int num_variables() const override { return 501; }
  };
  const auto problem = find_problem("hs071").make();
  const Many many(*problem);
  try {
    QuasiNewtonNlp approximate(many);
    FAIL() << "no exception";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("gives no Hessian and has 501 variables"));
  }
}

}  // namespace
}  // namespace tenon
