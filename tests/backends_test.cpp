// The back ends behind the solver contract: statuses, signs, warm starts, observers, compliant rows, and the factory's errors.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "small_problems.hpp"
#include "tenon/core/counted.hpp"
#include "tenon/core/with_slacks.hpp"
#include "tenon/problems/catalogue.hpp"
#include "tenon/solvers/make_solver.hpp"

namespace tenon {
namespace {

struct Answer {
  Point point;
  Result result;
};

Answer solve(const std::string& solver, const Nlp& problem, const Options& options = {}) {
  Answer answer{Point(problem.num_variables(), problem.num_constraints()), {}};
  problem.initial_point(answer.point.x);
  answer.result = make_solver(solver, problem, options)->solve(answer.point);
  return answer;
}

std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no exception";
}

bool is_available(const std::string& name) {
  const auto all = list_solvers();
  return std::ranges::any_of(all, [&](const auto& solver) { return solver.name == name && solver.available; });
}

/// The back ends that take any problem and solve it sharply.
class BackEnd : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    if (!is_available(GetParam())) GTEST_SKIP() << GetParam() << " is not available";
  }
};
INSTANTIATE_TEST_SUITE_P(Sharp, BackEnd, testing::Values("newton-kkt", "ipopt", "nlopt-slsqp"), [](const auto& p) {
  return p.param == "newton-kkt" ? "NewtonKkt" : p.param == "ipopt" ? "Ipopt" : "Slsqp";
});

TEST_P(BackEnd, MultipliersHaveTheSignOfTheSideTheyPushAt) {
  // hs071 as published: x1 at its lower bound 1 (z = -1.0879), product >= 25 active (lambda = -0.5523), sphere equality 0.1615.
  const Answer answer = solve(GetParam(), *find_problem("hs071").make());
  EXPECT_EQ(answer.result.status, Status::solved);
  EXPECT_NEAR(answer.point.x[0], 1, 1e-7);
  EXPECT_NEAR(answer.point.x[1], 4.7429994, 1e-6);
  EXPECT_NEAR(answer.point.lambda[0], -0.5522937, 1e-6);
  EXPECT_NEAR(answer.point.lambda[1], 0.1614686, 1e-6);
  EXPECT_NEAR(answer.point.z[0], -1.0878713, 1e-6);
  EXPECT_NEAR(answer.point.z[1], 0, 1e-6);
}

TEST_P(BackEnd, AFixedVariableGetsItsMultiplier) {
  const Answer answer = solve(GetParam(), fixed_variable(3));
  EXPECT_EQ(answer.result.status, Status::solved);
  EXPECT_NEAR(answer.point.x[0], 1.5, 1e-8);
  EXPECT_EQ(answer.point.x[1], 0.5);
  EXPECT_NEAR(answer.point.lambda[0], 1, 1e-8);
  EXPECT_NEAR(answer.point.z[1], 4, 1e-8);
}

TEST_P(BackEnd, AnInfeasibleProblemIsInfeasible) {
  const Answer answer = solve(GetParam(), infeasible());
  EXPECT_EQ(answer.result.status, Status::infeasible);
  EXPECT_NEAR(answer.result.residual.primal, 1, 1e-6);
}

TEST_P(BackEnd, AnUnboundedProblemIsUnbounded) { EXPECT_EQ(solve(GetParam(), unbounded()).result.status, Status::unbounded); }

TEST_P(BackEnd, AStartThatIsNotFiniteIsInvalidAndStaysWhereItWas) {
  const Answer answer = solve(GetParam(), Logarithm(-1));
  EXPECT_EQ(answer.result.status, Status::invalid_start);
  EXPECT_EQ(answer.point.x[0], -1);
}

TEST_P(BackEnd, AStepToWhereNothingIsFiniteIsShortened) {
  const Answer answer = solve(GetParam(), Logarithm(0.01));
  EXPECT_TRUE(succeeded(answer.result.status)) << to_string(answer.result.status);
  EXPECT_NEAR(answer.point.x[0], 1, 1e-6);
}

TEST_P(BackEnd, TheIterationLimitEndsTheSolve) {
  const Answer answer = solve(GetParam(), *find_problem("hs100").make(), {.max_iterations = 2});
  EXPECT_EQ(answer.result.status, Status::iteration_limit);
  EXPECT_EQ(answer.result.iterations, 2);
  EXPECT_EQ(solve(GetParam(), *find_problem("hs100").make(), {.max_iterations = 0}).result.status, Status::iteration_limit);
}

TEST_P(BackEnd, TheTimeLimitEndsTheSolve) {
  EXPECT_EQ(solve(GetParam(), *find_problem("hs100").make(), {.time_limit = 0}).result.status, Status::time_limit);
}

TEST_P(BackEnd, TheObserverSeesEveryIterateAndMayStop) {
  std::vector<int> indices;
  const auto stop_at_three = [&](const Iteration& iteration) {
    indices.push_back(iteration.index);
    return iteration.index < 3;
  };
  EXPECT_EQ(solve(GetParam(), *find_problem("hs100").make(), {.on_iteration = stop_at_three}).result.status, Status::stopped);
  EXPECT_EQ(indices, (std::vector<int>{0, 1, 2, 3}));
}

TEST_P(BackEnd, WhatTheObserverThrowsReachesTheCaller) {
  const auto broken = [](const Iteration&) -> bool { throw std::runtime_error("observer"); };
  EXPECT_THROW(solve(GetParam(), *find_problem("hs100").make(), {.on_iteration = broken}), std::runtime_error);
}

TEST_P(BackEnd, EachPointIsPreparedOnce) {
  const auto problem = find_problem("hs071").make();
  EvaluationCounts counts;
  const CountedNlp counted(*problem, counts);
  const Result result = solve(GetParam(), counted).result;
  EXPECT_EQ(result.status, Status::solved);
  EXPECT_LE(counts.prepare, counts.objective + 10) << "once for each objective, and for the evaluations that judge the end";
}

TEST_P(BackEnd, CompliantRowsAreSolvedAsSuch) {
  CompliantRow problem;
  Point point(2, 1);
  const auto solver = make_solver(GetParam(), problem);
  for (const double preload : {-0.1, 0.0, -3.0}) {  // the setter of the problem moves between solves of one solver
    problem.preload = preload;
    const Result result = solver->solve(point);
    EXPECT_TRUE(succeeded(result.status)) << to_string(result.status);
    EXPECT_NEAR(point.lambda[0], problem.expected_lambda(), 1e-7);
    EXPECT_NEAR(point.x[0], -problem.expected_lambda(), 1e-7);
    EXPECT_NEAR(result.objective, point.x[0] * point.x[0], 1e-12) << "without the price of the slack";
    EXPECT_LE(kkt_residual(problem, point).max_scaled(), 1e-7);
  }
}

TEST_P(BackEnd, APointOfTheWrongSizeIsAnError) {
  const auto problem = find_problem("hs071").make();
  Point point(3, 2);
  EXPECT_THROW(make_solver(GetParam(), *problem)->solve(point), std::invalid_argument);
}

TEST_P(BackEnd, TwoSolvesOfOneSolverAgreeBitwise) {
  const auto problem = find_problem("hs113").make();
  const auto solver = make_solver(GetParam(), *problem);
  Point first(10, 8), second(10, 8);
  problem->initial_point(first.x);
  problem->initial_point(second.x);
  const Result one = solver->solve(first), two = solver->solve(second);
  EXPECT_EQ(one.iterations, two.iterations);
  EXPECT_EQ(first.x, second.x);
  EXPECT_EQ(first.lambda, second.lambda);
}

TEST(Ipopt, AWarmStartFromTheAnswerTakesFewIterations) {
  if (!is_available("ipopt")) GTEST_SKIP();
  for (const CatalogueEntry& entry : catalogue()) {
    const auto problem = entry.make();
    Answer answer = solve("ipopt", *problem);
    // With some builds of BLAS the last step to hs001 is cut short, at 1e-7: roundings of the objective then decide how it goes on.
    if (answer.result.status != Status::solved) continue;
    const Result again = make_solver("ipopt", *problem, {.warm_start = true})->solve(answer.point);
    EXPECT_EQ(again.status, Status::solved) << entry.name;
    EXPECT_LE(again.iterations, 5) << entry.name;
  }
}

TEST(Ipopt, AProblemWithoutFreedomIsAnsweredByTheRuler) {
  if (!is_available("ipopt")) GTEST_SKIP();
  // x0 = 1 and x0^2 = 1: more equalities than variables, and yet a solution.
  const auto x = polynomial_variables(1);
  const PolynomialNlp problem({.name = "square", .start = vector({1}), .rows = {equals_zero(x[0] - 1), equals_zero(square(x[0]) - 1)}});
  EXPECT_TRUE(succeeded(solve("ipopt", problem).result.status));
}

TEST(Nlopt, MmaAndCcsaqTakeAllButEqualities) {
  for (const std::string name : {"nlopt-mma", "nlopt-ccsaq"}) {
    if (!is_available(name)) GTEST_SKIP();
    const Answer answer = solve(name, *find_problem("hs012").make());
    EXPECT_TRUE(succeeded(answer.result.status)) << to_string(answer.result.status);
    EXPECT_NEAR(answer.point.lambda[0], -0.5, 1e-4);
    const auto with_equality = find_problem("hs071").make();
    EXPECT_NE(message_of([&] { make_solver(name, *with_equality); }).find("takes no equality rows"), std::string::npos);
  }
}

TEST(MakeSolver, AnUnknownNameIsAnErrorThatNamesTheNearest) {
  const auto problem = find_problem("hs071").make();
  EXPECT_NE(message_of([&] { make_solver("ipop", *problem); }).find("\"ipopt\""), std::string::npos);
  EXPECT_NE(message_of([&] { make_solver("nlopt-slqp", *problem); }).find("\"nlopt-slsqp\""), std::string::npos);
}

TEST(MakeSolver, ABackEndThatIsNotAvailableIsAnErrorThatSaysSo) {
  const auto problem = find_problem("hs012").make();
  for (const SolverDescription& solver : list_solvers()) {
    if (solver.available) EXPECT_NE(make_solver(solver.name, *problem), nullptr) << solver.name;
    else EXPECT_NE(message_of([&] { make_solver(solver.name, *problem); }).find("not available"), std::string::npos) << solver.name;
  }
}

TEST(MakeSolver, OptionsThatMakeNoSenseAreErrors) {
  const auto problem = find_problem("hs012").make();
  for (const SolverDescription& solver : list_solvers()) {
    EXPECT_THROW(make_solver(solver.name, *problem, {.tolerance = 0}), std::invalid_argument) << solver.name;
    EXPECT_THROW(make_solver(solver.name, *problem, {.max_iterations = -1}), std::invalid_argument) << solver.name;
  }
}

TEST(MakeSolver, EveryBackEndSaysWhatItIsAndWhatItSets) {
  for (const SolverDescription& solver : list_solvers()) {
    EXPECT_FALSE(solver.description.empty()) << solver.name;
    EXPECT_EQ(solver.options.empty(), !solver.available) << solver.name;
  }
}

}  // namespace
}  // namespace tenon
