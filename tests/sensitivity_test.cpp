// The solution's derivatives by parameters, against differences of solutions.
#include "tenon/core/sensitivity.hpp"

#include <gtest/gtest.h>

#include "small_problems.hpp"
#include "tenon/problems/catalogue.hpp"
#include "tenon/solvers/make_solver.hpp"

namespace tenon {
namespace {

/// A problem with the objective f + p0 (x_0 + x_0^2/2), rows c_j + p1 and upper and lower bounds of x moved by p2.
class Moved final : public ParametricNlp {
 public:
  explicit Moved(const Nlp& problem) : problem_(problem) {}
  Eigen::Vector3d p = Eigen::Vector3d::Zero();

  int num_parameters() const override { return 3; }
  void parameter_derivatives(ConstVectorRef x, ConstVectorRef, Workspace&, ParameterDerivatives& out) const override {
    out.gradient(0, 0) = 1 + x[0];
    out.rows.col(1).setOnes();
    out.bounds.col(2).setOnes();
  }

  int num_variables() const override { return problem_.num_variables(); }
  int num_constraints() const override { return problem_.num_constraints(); }
  SparsePattern jacobian_pattern() const override { return problem_.jacobian_pattern(); }
  SparsePattern hessian_pattern() const override { return SparsePattern::full_lower(num_variables()); }
  void bounds(Bounds& bounds) const override {
    problem_.bounds(bounds);
    bounds.x_lower.array() += p[2];
    bounds.x_upper.array() += p[2];
  }
  void initial_point(VectorRef x) const override { problem_.initial_point(x); }
  Workspace make_workspace() const override { return problem_.make_workspace(); }
  void prepare(ConstVectorRef x, Workspace& w) const override { problem_.prepare(x, w); }
  double objective(ConstVectorRef x, Workspace& w) const override { return problem_.objective(x, w) + p[0] * (x[0] + x[0] * x[0] / 2); }
  void gradient(ConstVectorRef x, Workspace& w, VectorRef gradient) const override {
    problem_.gradient(x, w, gradient);
    gradient[0] += p[0] * (1 + x[0]);
  }
  void constraints(ConstVectorRef x, Workspace& w, VectorRef values) const override {
    problem_.constraints(x, w, values);
    values.array() += p[1];
  }
  void jacobian(ConstVectorRef x, Workspace& w, std::span<double> values) const override { problem_.jacobian(x, w, values); }
  void hessian(ConstVectorRef x, double sigma, ConstVectorRef lambda, Workspace& w, std::span<double> values) const override {
    SparseMatrix inner = problem_.hessian_pattern().zero_matrix();
    problem_.hessian(x, sigma, lambda, w, values_of(inner));
    const Eigen::MatrixXd dense = inner;
    std::size_t k = 0;
    for (int j = 0; j < num_variables(); ++j) {
      for (int i = j; i < num_variables(); ++i) values[k++] = dense(i, j) + (i == 0 && j == 0 ? sigma * p[0] : 0);
    }
  }

 private:
  const Nlp& problem_;
};

Point solution(const Nlp& problem, const Point* start = nullptr) {
  Point point(problem.num_variables(), problem.num_constraints());
  if (start != nullptr)
    point = *start;
  else
    problem.initial_point(point.x);
  const Result result = make_solver("newton-kkt", problem, {.tolerance = 1e-11, .warm_start = start != nullptr})->solve(point);
  EXPECT_LE(result.residual.max_scaled(), 1e-9) << to_string(result.status);
  return point;
}

class SolutionMoves : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(OfTheCatalogue, SolutionMoves,
                         testing::Values("hs028", "hs035", "hs039", "hs040", "hs043", "hs071", "hs076", "hs093", "hs100", "hs113"),
                         [](const auto& p) { return p.param; });

TEST_P(SolutionMoves, AsDifferencesOfSolutionsSay) {
  const auto problem = find_problem(GetParam()).make();
  Moved moved(*problem);
  const Point at = solution(moved);
  const Sensitivity slopes = sensitivity(moved, at);
  ASSERT_TRUE(slopes.is_unique);
  ASSERT_GE(slopes.complementarity_gap, 1e-4) << "the active set is clear";
  for (int k = 0; k < 3; ++k) {
    const double h = 1e-5;
    moved.p[k] = h;
    const Point ahead = solution(moved, &at);
    moved.p[k] = -h;
    const Point behind = solution(moved, &at);
    moved.p[k] = 0;
    const auto close = [&](const Eigen::MatrixXd& slope, const Vector& plus, const Vector& minus, const char* what) {
      const Vector difference = (plus - minus) / (2 * h);
      if (difference.size() == 0) return;
      EXPECT_LE((slope.col(k) - difference).lpNorm<Eigen::Infinity>(), 1e-3 * std::max(1.0, difference.lpNorm<Eigen::Infinity>()))
          << what << " by p" << k << "\n"
          << slope.col(k).transpose() << "\n"
          << difference.transpose();
    };
    close(slopes.x, ahead.x, behind.x, "x");
    close(slopes.lambda, ahead.lambda, behind.lambda, "lambda");
    close(slopes.z, ahead.z, behind.z, "z");
  }
}

TEST(Sensitivity, ACompliantRowGivesWayWhileItMoves) {
  // x0 = x1 = -lambda,  lambda = (D preload - 2 + p1)/(2 + D)
  const CompliantRow spring;
  const Moved problem(spring);
  const Sensitivity slopes = sensitivity(problem, solution(problem));
  ASSERT_TRUE(slopes.is_unique);
  EXPECT_NEAR(slopes.lambda(0, 1), 1 / (2 + spring.compliance), 1e-9);
  EXPECT_NEAR(slopes.x(0, 1), -1 / (2 + spring.compliance), 1e-9);
}

TEST(Sensitivity, WhereMultipliersAreNotUniqueItSaysSo) {
  const auto x = polynomial_variables(2);
  const PolynomialNlp twice({.name = "twice",
                             .start = vector({0, 0}),
                             .objective = square(x[0]) + square(x[1]),
                             .rows = {equals_zero(x[0] + x[1] - 1), equals_zero(2 * x[0] + 2 * x[1] - 2)}});
  const Moved moved(twice);
  Point point(2, 2);
  point.x << 0.5, 0.5;
  point.lambda << -1, 0;
  const Sensitivity slopes = sensitivity(moved, point);
  EXPECT_FALSE(slopes.is_unique);
  EXPECT_EQ(slopes.x.norm(), 0);
}

TEST(Sensitivity, WhereABoundIsBarelyActiveTheGapSaysSo) {
  // min (x - p0)^2 with x >= 0 at p0 = 0: the multiplier and the distance are both 0
  const auto x = polynomial_variables(1);
  const PolynomialNlp corner({.name = "corner", .start = vector({1}), .x_lower = vector({0}), .objective = square(x[0])});
  const Moved moved(corner);
  EXPECT_LE(sensitivity(moved, Point(1, 0)).complementarity_gap, 1e-12);
}

}  // namespace
}  // namespace tenon
