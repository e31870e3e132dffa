// The nouns of core on their own: names, decorators, the lift from fixed size.
#include <gtest/gtest.h>

#include "small_problems.hpp"
#include "tenon/core/as_nlp.hpp"
#include "tenon/core/check_derivatives.hpp"
#include "tenon/core/counted.hpp"
#include "tenon/core/nearest_name.hpp"
#include "tenon/core/solver.hpp"
#include "tenon/core/with_slacks.hpp"

namespace tenon {
namespace {

/// min x0^2 x1 + x1^2  s.t.  x0 x1 = 1,  x0 + 2 x1 in [0, 4],  x0 >= 0, at fixed size.
struct FixedSizeProblem {
  using Scalar = double;
  struct Workspace {
    double product = 0;  // x0 x1, so that a forgotten prepare() shows
  };
  static constexpr int kVariables = 2;
  static constexpr int kConstraints = 2;
  int num_variables() const { return 2; }
  int num_constraints() const { return 2; }
  Workspace make_workspace() const { return {}; }
  void bounds(BasicBounds<double, 2, 2>& bounds) const {
    bounds.x_lower[0] = 0;
    bounds.c_lower << 1, 0;
    bounds.c_upper << 1, 4;
    bounds.compliance[1] = 0.25;
    bounds.preload[1] = -3;
  }
  void initial_point(Eigen::Vector2d& x) const { x << 1.5, 0.5; }
  void prepare(const Eigen::Vector2d& x, Workspace& w) const { w.product = x[0] * x[1]; }
  double objective(const Eigen::Vector2d& x, Workspace& w) const { return x[0] * w.product + x[1] * x[1]; }
  void gradient(const Eigen::Vector2d& x, Workspace& w, Eigen::Vector2d& g) const { g << 2 * w.product, x[0] * x[0] + 2 * x[1]; }
  void constraints(const Eigen::Vector2d& x, Workspace& w, Eigen::Vector2d& c) const { c << w.product, x[0] + 2 * x[1]; }
  void jacobian(const Eigen::Vector2d& x, Workspace&, Eigen::Matrix2d& j) const { j << x[1], x[0], 1, 2; }
  void hessian(const Eigen::Vector2d& x, double sigma, const Eigen::Vector2d& lambda, Workspace&, Eigen::Matrix2d& h) const {
    h << sigma * 2 * x[1], 0, sigma * 2 * x[0] + lambda[0], sigma * 2;
  }
  std::string name() const { return "fixed size"; }
};
static_assert(NonlinearProgram<FixedSizeProblem>);

TEST(NearestName, EditDistanceCountsInsertionsDeletionsAndReplacements) {
  EXPECT_EQ(edit_distance("", ""), 0);
  EXPECT_EQ(edit_distance("", "abc"), 3);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
  EXPECT_EQ(edit_distance("sitting", "kitten"), 3);
  EXPECT_EQ(edit_distance("ipopt", "ipopt"), 0);
}

TEST(NearestName, TheNearestIsNamedAndTheFirstAmongEquals) {
  EXPECT_EQ(nearest_name("ipop", {"nlopt-mma", "ipopt", "newton-kkt"}), "ipopt");
  EXPECT_EQ(nearest_name("hs72", {"hs071", "hs076"}), "hs071");
  EXPECT_EQ(nearest_name("anything", {}), "");
}

TEST(AsNlp, AgreesWithTheFixedSizeProblemInEveryEvaluation) {
  const FixedSizeProblem fixed;
  const AsNlp lifted(fixed);
  const Eigen::Vector2d x(1.2, -0.7), lambda(0.3, 2);
  FixedSizeProblem::Workspace w = fixed.make_workspace();
  fixed.prepare(x, w);
  Eigen::Vector2d fixed_gradient, fixed_rows;
  Eigen::Matrix2d fixed_jacobian, fixed_hessian;
  fixed.gradient(x, w, fixed_gradient);
  fixed.constraints(x, w, fixed_rows);
  fixed.jacobian(x, w, fixed_jacobian);
  fixed.hessian(x, 0.5, lambda, w, fixed_hessian);

  Nlp::Workspace workspace = lifted.make_workspace();
  lifted.prepare(x, workspace);
  Vector gradient(2), rows(2);
  SparseMatrix jacobian = lifted.jacobian_pattern().zero_matrix(), hessian = lifted.hessian_pattern().zero_matrix();
  lifted.gradient(x, workspace, gradient);
  lifted.constraints(x, workspace, rows);
  lifted.jacobian(x, workspace, values_of(jacobian));
  lifted.hessian(x, 0.5, lambda, workspace, values_of(hessian));

  EXPECT_EQ(lifted.objective(x, workspace), fixed.objective(x, w));
  EXPECT_EQ(gradient, fixed_gradient);
  EXPECT_EQ(rows, fixed_rows);
  EXPECT_EQ(Eigen::MatrixXd(jacobian), fixed_jacobian);
  EXPECT_EQ(Eigen::MatrixXd(hessian), Eigen::MatrixXd(fixed_hessian.triangularView<Eigen::Lower>()));
  EXPECT_EQ(lifted.name(), "fixed size");
}

TEST(AsNlp, HandsOnBoundsComplianceAndStart) {
  const FixedSizeProblem fixed;
  const AsNlp lifted(fixed);
  Bounds bounds(2, 2);
  lifted.bounds(bounds);
  EXPECT_EQ(bounds.x_lower, vector({0, -kInfinity<double>}));
  EXPECT_EQ(bounds.c_upper, vector({1, 4}));
  EXPECT_EQ(bounds.compliance, vector({0, 0.25}));
  EXPECT_EQ(bounds.preload, vector({0, -3}));
  Vector x(2);
  lifted.initial_point(x);
  EXPECT_EQ(x, vector({1.5, 0.5}));
}

TEST(AsNlp, ItsDerivativesObeyTheLaw) {
  const FixedSizeProblem fixed;
  EXPECT_TRUE(check_derivatives(AsNlp(fixed), vector({1.2, -0.7}), 0.5, vector({0.3, 2})).passed(1e-6));
}

TEST(CountedNlp, CountsEachKindOfEvaluationOnce) {
  const PolynomialNlp problem = fixed_variable(1);
  EvaluationCounts counts;
  const CountedNlp counted(problem, counts);
  const Vector x = vector({1, 0.5});
  Nlp::Workspace workspace = counted.make_workspace();
  Vector gradient(2), rows(1);
  SparseMatrix jacobian = counted.jacobian_pattern().zero_matrix(), hessian = counted.hessian_pattern().zero_matrix();
  counted.prepare(x, workspace);
  counted.objective(x, workspace);
  counted.objective(x, workspace);
  counted.gradient(x, workspace, gradient);
  counted.constraints(x, workspace, rows);
  counted.jacobian(x, workspace, values_of(jacobian));
  counted.hessian(x, 1, rows, workspace, values_of(hessian));
  EXPECT_EQ(counts, (EvaluationCounts{.prepare = 1, .objective = 2, .gradient = 1, .constraints = 1, .jacobian = 1, .hessian = 1}));
}

TEST(WithSlacks, ItsDerivativesObeyTheLaw) {
  const CompliantRow problem;
  const WithSlacks slacked(problem);
  EXPECT_EQ(slacked.num_variables(), 3);
  EXPECT_EQ(slacked.variable_name(2), "slack of spring");
  EXPECT_TRUE(check_derivatives(slacked, vector({0.3, -0.2, 0.7}), 0.8, vector({1.3})).passed(1e-6));
}

TEST(WithSlacks, ThePointOfTheCompliantProblemIsOneOfTheSlackedAndBack) {
  const CompliantRow problem;
  const WithSlacks slacked(problem);
  Point point(2, 1);
  point.lambda[0] = problem.expected_lambda();
  point.x.setConstant(-point.lambda[0]);
  ASSERT_LE(kkt_residual(problem, point).max(), 1e-15);

  const Point lifted = slacked.lift(point);
  EXPECT_DOUBLE_EQ(lifted.x[2], problem.compliance * (point.lambda[0] - problem.preload));
  EXPECT_LE(kkt_residual(slacked, lifted).max(), 1e-15);

  Point back(2, 1);
  slacked.lower(lifted, back);
  EXPECT_EQ(back.x, point.x);
  EXPECT_EQ(back.lambda, point.lambda);
}

TEST(WithSlacks, ARowThatHasBecomeHardHoldsItsSlackAtZero) {
  CompliantRow problem;
  WithSlacks slacked(problem);
  problem.compliance = 0;
  slacked.update();
  Bounds bounds(3, 1);
  slacked.bounds(bounds);
  EXPECT_EQ(bounds.x_lower[2], 0);
  EXPECT_EQ(bounds.x_upper[2], 0);
}

TEST(WithSlacks, ARowThatBecomesCompliantLaterIsAnErrorThatNamesIt) {
  CompliantRow problem;
  problem.compliance = 0;
  WithSlacks slacked(problem);
  problem.compliance = 1;
  try {
    slacked.update();
    FAIL() << "no exception";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("spring"), std::string::npos) << error.what();
  }
}

TEST(Polynomial, IsDifferentiatedByRule) {
  const auto x = polynomial_variables(2);
  const Polynomial p = 3 * power(x[0], 3) * x[1] - 2 * x[1] + 5;
  const Vector at = vector({2, -1});
  EXPECT_EQ(p(at), -24 + 2 + 5);
  EXPECT_EQ(p.derivative(0)(at), -36);
  EXPECT_EQ(p.derivative(1)(at), 22);
  EXPECT_TRUE(p.derivative(1).derivative(1).is_zero());
}

}  // namespace
}  // namespace tenon
