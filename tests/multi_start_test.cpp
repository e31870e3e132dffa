// Many starts find many optima, the same ones every time, and the best of them comes first.
#include "tenon/core/multi_start.hpp"

#include <gtest/gtest.h>

#include "small_problems.hpp"
#include "tenon/problems/catalogue.hpp"
#include "tenon/solvers/make_solver.hpp"

namespace tenon {
namespace {

/// min (x0^2 - 1)^2 + (x1^2 - 4)^2 + x0/10 + x1/10: four local optima, the best near (-1, -2).
PolynomialNlp four_wells() {
  const auto x = polynomial_variables(2);
  return PolynomialNlp({.name = "four_wells",
                        .start = vector({2, 3}),
                        .objective = square(square(x[0]) - 1) + square(square(x[1]) - 4) + 0.1 * x[0] + 0.1 * x[1]});
}

MultiStart run(const Nlp& problem, int starts, std::uint64_t seed, const Options& options = {}) {
  Point start(problem.num_variables(), problem.num_constraints());
  problem.initial_point(start.x);
  return multi_start(problem, *make_solver("newton-kkt", problem, options), start, starts, seed);
}

TEST(MultiStart, FindsEveryWellAndTheDeepestFirst) {
  const MultiStart found = run(four_wells(), 40, 1);
  ASSERT_EQ(found.optima.size(), 4u);
  EXPECT_LT(found.optima[0].point.x[0], 0);
  EXPECT_LT(found.optima[0].point.x[1], 0);
  int solves = found.failed;
  for (std::size_t k = 0; k < 4; ++k) {
    solves += found.optima[k].found;
    if (k > 0) {
      EXPECT_GT(found.optima[k].result.objective, found.optima[k - 1].result.objective);
    }
  }
  EXPECT_EQ(solves, 40);
}

TEST(MultiStart, OneStartIsTheProblemsOwn) {
  const MultiStart found = run(four_wells(), 1, 7);
  ASSERT_EQ(found.optima.size(), 1u);
  EXPECT_EQ(found.optima[0].start.x, vector({2, 3}));
  EXPECT_EQ(found.starts, 1);
}

TEST(MultiStart, TheSameSeedGivesTheSameAnswersAndAnotherOthers) {
  const MultiStart one = run(four_wells(), 10, 3), two = run(four_wells(), 10, 3), other = run(four_wells(), 10, 4);
  ASSERT_EQ(one.optima.size(), two.optima.size());
  for (std::size_t k = 0; k < one.optima.size(); ++k) {
    EXPECT_EQ(one.optima[k].point.x, two.optima[k].point.x);
    EXPECT_EQ(one.optima[k].found, two.optima[k].found);
  }
  EXPECT_NE(one.optima.front().start.x, other.optima.front().start.x);
}

TEST(MultiStart, ItsStartsLieWithinTheBounds) {
  const auto problem = find_problem("hs071").make();
  const MultiStart found = run(*problem, 20, 1);
  for (const Optimum& optimum : found.optima) {
    EXPECT_GE(optimum.start.x.minCoeff(), 1);
    EXPECT_LE(optimum.start.x.maxCoeff(), 5);
  }
  EXPECT_NEAR(found.optima[0].result.objective, 17.0140173, 1e-6);
}

TEST(MultiStart, WhereNothingSucceedsTheEndWithTheLeastResidualIsKept) {
  const MultiStart found = run(infeasible(), 5, 1);
  ASSERT_EQ(found.optima.size(), 1u);
  EXPECT_EQ(found.failed, 5);
  EXPECT_EQ(found.optima[0].result.status, Status::infeasible);
}

TEST(MultiStart, AnObserverThatStopsASolveStopsThemAll) {
  int iterations = 0;
  const MultiStart found = run(four_wells(), 50, 1, {.on_iteration = [&](const Iteration&) { return ++iterations < 30; }});
  EXPECT_LT(found.starts, 50);
}

TEST(MultiStart, NoStartIsAnError) {
  EXPECT_THROW(run(four_wells(), 0, 1), std::invalid_argument);
}

}  // namespace
}  // namespace tenon
