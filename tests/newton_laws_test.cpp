// Newton-KKT, law by law: the last steps are quadratic, compliant rows are springs, a warm start follows small changes, restoration helps
// where the line search gives up, and single precision is enough for a small controller.
#include <algorithm>

#include <gtest/gtest.h>

#include "tenon/tests/fixed_size_problems.hpp"
#include "tenon/tests/newton_runs.hpp"

namespace tenon {
namespace {

TEST(InertiaCorrection, ShowsInTheTraceOfANonConvexProblem) {
  const Traced run = run_dense(NonConvex<>());
  EXPECT_EQ(run.result.status, Status::solved);
  EXPECT_TRUE(std::ranges::any_of(run.trace, [](const Iteration& iteration) { return iteration.regularization > 0; }));
  EXPECT_EQ(run.trace.back().regularization, 0) << "the last step is Newton's own";
}

TEST(WarmStart, FollowsASmallChangeOfABoundInFiveIterations) {
  EqualityAndBounds<> a;
  TwoSidedRows<> b;
  const auto run = [](auto& problem, double& bound, double change) {
    using P = std::remove_reference_t<decltype(problem)>;
    PointOf<P> point = start_of(problem);
    NewtonKkt<P> cold(problem), warm(problem, {.warm_start = true});
    ASSERT_EQ(cold.solve(point).status, Status::solved);
    for (const double step : {change, -change, -change, change}) {
      bound += step;
      const Result result = warm.solve(point);
      EXPECT_EQ(result.status, Status::solved);
      EXPECT_LE(result.iterations, 5) << "after " << step;
    }
  };
  run(a, a.product, 0.05);
  run(b, b.most, 0.005);
}

TEST(Order, TheLastStepsAreQuadratic) {
  const Traced run = run_dense(CurvedEqualities<>(), {.tolerance = 1e-13});
  ASSERT_TRUE(succeeded(run.result.status)) << to_string(run.result.status);
  // r_{k+1} <= C r_k^2, from where Newton's steps are full down to rounding
  int steps = 0;
  const auto r = [](const Iteration& iteration) { return std::max(iteration.primal, iteration.dual); };
  for (std::size_t k = 1; k < run.trace.size(); ++k) {
    if (r(run.trace[k - 1]) > 0.1) continue;
    ++steps;
    EXPECT_EQ(run.trace[k].alpha_primal, 1) << k;
    EXPECT_LE(r(run.trace[k]), 10 * r(run.trace[k - 1]) * r(run.trace[k - 1]) + 1e-14) << k;
  }
  EXPECT_GE(steps, 3);
}

TEST(CompliantRows, GiveWayAsTheRulerSays) {
  SpringRow<> problem;
  for (const double compliance : {1e-3, 0.1, 10.0}) {
    for (const double preload : {-0.5, 0.0, 2.0}) {
      problem.compliance = compliance, problem.preload = preload;
      for (const Traced& run : {run_dense(problem), run_sparse(problem)}) {
        EXPECT_EQ(run.result.status, Status::solved);
        EXPECT_LE(run.result.residual.max_scaled(), 1e-8);
        const double e = run.point.x[0] + 2 * run.point.x[1] - 3;
        EXPECT_NEAR(e, compliance * (run.point.lambda[0] - preload), 1e-8);
      }
    }
  }
}

TEST(CompliantRows, TendToTheHardSolutionWithTheirCompliance) {
  SpringRow<> problem;
  const Traced hard = run_dense(problem);
  double before = kInfinity<double>;
  for (const double compliance : {1e-1, 1e-3, 1e-5, 1e-7}) {
    problem.compliance = compliance;
    const Traced soft = run_dense(problem);
    EXPECT_EQ(soft.result.status, Status::solved) << compliance;
    const double distance = (soft.point.x - hard.point.x).norm();
    EXPECT_LE(distance, compliance);
    EXPECT_LT(distance, before);
    before = distance;
    EXPECT_LE((soft.point.lambda - hard.point.lambda).norm(), compliance + 1e-7);
  }
}

TEST(CompliantRows, OpposedRowsSettleAtTheLeastWeightedViolation) {
  for (const double ratio : {1.0, 0.1, 30.0}) {
    for (const double pull : {0.0, 0.5}) {
      for (const double scale : {1.0, 1e-4}) {
        OpposedRows<> problem;
        problem.compliance << scale * ratio, scale;
        problem.pull = pull;
        const double d0 = problem.compliance[0], d1 = problem.compliance[1];
        const double both = (d1 - d0 - pull * d0 * d1) / (d0 + d1);
        const double expected = both > -1 ? both : 1 - pull * d0;  // below -1 the second row is met
        for (const Traced& run : {run_dense(problem), run_sparse(problem)}) {
          EXPECT_EQ(to_string(run.result.status), to_string(Status::solved)) << "D " << d0 << ", " << d1 << ", pull " << pull;
          EXPECT_NEAR(run.point.x[0], expected, 1e-6);
          EXPECT_LE(run.result.residual.max_scaled(), 1e-8);
        }
      }
    }
  }
}

TEST(Restoration, FindsTheWayOutOfADeadEnd) {
  using P = DeadEnd<>;
  const P problem;
  NewtonKkt<P, KktOf<P>, NoRestoration> alone(problem);
  auto point = start_of(problem);
  EXPECT_EQ(to_string(alone.solve(point).status), to_string(Status::numerical_failure));
  EXPECT_TRUE(point.x.allFinite());
  for (const Traced& run : {run_dense(problem), run_sparse(problem)}) {
    EXPECT_EQ(run.result.status, Status::solved);
    EXPECT_NEAR(run.result.objective, 1, 1e-7);
  }
}

TEST(SinglePrecision, SolvesToItsOwnAccuracy) {
  const auto solve = [](const auto& problem, const auto& twin) {
    using P = std::remove_cvref_t<decltype(problem)>;
    const Traced reference = run_dense(twin);
    NewtonKkt<P> solver(problem, {.tolerance = 1e-4, .max_iterations = 200});
    PointOf<P> point = start_of(problem);
    const Result result = solver.solve(point);
    EXPECT_EQ(to_string(result.status), to_string(Status::solved));
    EXPECT_LE(result.residual.max_scaled(), 1e-4);
    EXPECT_LE((point.x.template cast<double>() - reference.point.x).norm(), 5e-3) << point.x.transpose();
  };
  solve(EqualityAndBounds<float>(), EqualityAndBounds<>());
  solve(TwoSidedRows<float>(), TwoSidedRows<>());
  solve(NonConvex<float>(), NonConvex<>());
  solve(FixedVariable<float>(), FixedVariable<>());
  solve(CurvedEqualities<float>(), CurvedEqualities<>());
  solve(SpringRow<float>(), SpringRow<>());
}

}  // namespace
}  // namespace tenon
