// Newton-KKT, status by status: each is provoked on the path of fixed size and on the sparse one. Whatever the status, the point is finite,
// is the last accepted iterate, and the residual is what the independent ruler says of it.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tenon/core/check_derivatives.hpp"
#include "tenon/tests/fixed_size_problems.hpp"
#include "tenon/tests/newton_runs.hpp"

namespace tenon {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

template <class P>
void expect_honest(const P& problem, const Traced& run) {
  const AsNlp<P> nlp(problem);
  EXPECT_TRUE(run.point.x.allFinite()) << run.point.x.transpose();
  const KktResidual ruler = kkt_residual(nlp, run.point);
  const auto expect_close = [](double mine, double other) {
    EXPECT_TRUE(mine == other || std::abs(mine - other) <= 1e-13 * (1 + std::abs(other))) << mine << " and " << other;
  };
  expect_close(run.result.residual.stationarity, ruler.stationarity);
  expect_close(run.result.residual.primal, ruler.primal);
  expect_close(run.result.residual.complementarity, ruler.complementarity);
  expect_close(run.result.residual.scale, ruler.scale);

  auto workspace = nlp.make_workspace();
  nlp.prepare(run.point.x, workspace);
  EXPECT_EQ(run.result.objective, nlp.objective(run.point.x, workspace));
}

/// As above, and the last line of the trace tells of the point that was returned.
template <class P>
void expect_last_iterate(const P& problem, const Traced& run) {
  expect_honest(problem, run);
  ASSERT_FALSE(run.trace.empty());
  EXPECT_EQ(run.trace.back().index, run.result.iterations);
  EXPECT_EQ(run.trace.back().objective, run.result.objective);
  EXPECT_TRUE(run.point.lambda.allFinite() && run.point.z.allFinite());
}

template <class P, class Expectation>
void on_both_paths(const P& problem, const Options& options, const Expectation& expectation) {
  {
    SCOPED_TRACE("fixed size");
    expectation(run_dense(problem, options));
  }
  SCOPED_TRACE("sparse");
  expectation(run_sparse(problem, options));
}

void expect_status(const Traced& run, Status status) { EXPECT_EQ(to_string(run.result.status), to_string(status)); }

TEST(Status, Solved) {
  const EqualityAndBounds<> problem;
  on_both_paths(problem, {}, [&](const Traced& run) {
    expect_status(run, Status::solved);
    expect_last_iterate(problem, run);
    EXPECT_LE(run.result.residual.max_scaled(), 1e-8);
    EXPECT_NEAR(run.result.objective, 17.0140173, 1e-6);
  });
}

TEST(Status, AcceptableWhereTheArithmeticEndsBeforeTheTolerance) {
  const EqualityAndBounds<> problem;
  const double tolerance = 2e-16;
  on_both_paths(problem, {.tolerance = tolerance, .max_iterations = 500}, [&](const Traced& run) {
    expect_status(run, Status::acceptable);
    expect_last_iterate(problem, run);
    EXPECT_GT(run.result.residual.max_scaled(), tolerance);
    EXPECT_LE(run.result.residual.max_scaled(), kAcceptableFactor * tolerance);
  });
}

TEST(Status, Infeasible) {
  const BallOfNegativeRadius problem;
  on_both_paths(problem, {}, [&](const Traced& run) {
    expect_status(run, Status::infeasible);
    expect_honest(problem, run);
    EXPECT_NEAR(run.result.residual.primal, 1, 1e-6);
    EXPECT_LE(run.point.x.norm(), 1e-4) << "the violation is stationary at 0 alone";
  });
}

TEST(Status, InfeasibleWithOpposedLinearRows) {
  const OpposedRows<> problem;
  on_both_paths(problem, {}, [&](const Traced& run) {
    expect_status(run, Status::infeasible);
    expect_honest(problem, run);
    EXPECT_NEAR(run.point.x[0], 0, 1e-4) << "the sum of squared violations is least half-way";
    EXPECT_NEAR(run.result.residual.primal, 1, 1e-4);
  });
}

TEST(Status, Unbounded) {
  const Downhill problem;
  on_both_paths(problem, {}, [&](const Traced& run) {
    expect_status(run, Status::unbounded);
    expect_last_iterate(problem, run);
    EXPECT_LT(run.result.objective, -1e18);
  });
}

TEST(Status, IterationLimit) {
  const EqualityAndBounds<> problem;
  for (const int limit : {0, 1, 3}) {
    on_both_paths(problem, {.max_iterations = limit}, [&](const Traced& run) {
      expect_status(run, Status::iteration_limit);
      expect_last_iterate(problem, run);
      EXPECT_EQ(run.result.iterations, limit);
    });
  }
}

TEST(Status, TimeLimit) {
  const EqualityAndBounds<> problem;
  on_both_paths(problem, {.time_limit = 0}, [&](const Traced& run) {
    expect_status(run, Status::time_limit);
    expect_last_iterate(problem, run);
    EXPECT_EQ(run.result.iterations, 0);
  });
}

/// One second goes by each time somebody looks.
struct TickingClock {
  using duration = std::chrono::seconds;
  using rep = duration::rep;
  using period = duration::period;
  using time_point = std::chrono::time_point<TickingClock>;
  static time_point now() { return time_point(duration(looks++)); }
  static inline long looks = 0;
};

TEST(Status, TimeLimitByTheCallersOwnClock) {
  using P = EqualityAndBounds<>;
  const P problem;
  Traced run;
  NewtonKkt<P, KktOf<P>, Restoration<P>, TickingClock> solver(problem, tracing({.time_limit = 4}, run.trace));
  auto point = start_of(problem);
  run.result = solver.solve(point);
  run.point = to_point<P>(point);
  expect_status(run, Status::time_limit);
  expect_last_iterate(problem, run);
  EXPECT_EQ(run.result.iterations, 3) << "a look at each iterate: 1, 2, 3, 4 s";
  EXPECT_EQ(run.result.elapsed, 5);
}

TEST(Status, NoClockKnowsNoTimeLimit) {
  using P = EqualityAndBounds<>;
  const P problem;
  NewtonKkt<P, KktOf<P>, Restoration<P>, NoClock> solver(problem, {.time_limit = 1e-9});
  auto point = start_of(problem);
  const Result result = solver.solve(point);
  EXPECT_EQ(result.status, Status::solved);
  EXPECT_EQ(result.elapsed, 0);
}

TEST(Status, Stopped) {
  const EqualityAndBounds<> problem;
  on_both_paths(problem, {.on_iteration = [](const Iteration& iteration) { return iteration.index < 2; }}, [&](const Traced& run) {
    expect_status(run, Status::stopped);
    expect_last_iterate(problem, run);
    EXPECT_EQ(run.result.iterations, 2);
  });
}

TEST(Status, InvalidStart) {
  for (const Spoil what : {Spoil::objective, Spoil::gradient, Spoil::constraints, Spoil::jacobian}) {
    SCOPED_TRACE(static_cast<int>(what));
    const Spoilt<EqualityAndBounds<>> problem(what, [](const auto&) { return true; });
    on_both_paths(problem, {}, [&](const Traced& run) {
      expect_status(run, Status::invalid_start);
      EXPECT_EQ(run.result.iterations, 0);
      EXPECT_TRUE(run.trace.empty());
      EXPECT_TRUE(run.point.x.allFinite() && run.point.lambda.allFinite() && run.point.z.allFinite());
      EXPECT_FALSE(run.result.residual.max_scaled() <= 1) << "nothing good can be said of this point";
    });
  }
}

TEST(Status, InvalidStartWhereTheGuessIsNotANumber) {
  const EqualityAndBounds<> problem;
  NewtonKkt<EqualityAndBounds<>> solver(problem);
  auto point = start_of(problem);
  point.x[2] = kNan;
  const Result result = solver.solve(point);
  EXPECT_EQ(to_string(result.status), to_string(Status::invalid_start));
  EXPECT_FALSE(result.residual.max_scaled() <= 1);
}

TEST(Status, InvalidStartLeavesNothingOfTheSolveBefore) {
  const OneVariable problem(1, [](double x) { return x - std::log(x); }, [](double x) { return 1 - 1 / x; },
                            [](double x) { return 1 / (x * x); });
  NewtonKkt<OneVariable> solver(problem);
  auto point = start_of(problem);
  ASSERT_EQ(solver.solve(point).status, Status::solved);
  point.x[0] = -1;
  const Result result = solver.solve(point);
  EXPECT_EQ(result.status, Status::invalid_start);
  EXPECT_EQ(point.x[0], -1);
  EXPECT_EQ(point.z[0], 0);
  EXPECT_FALSE(result.residual.max_scaled() <= 1) << "the gradient of the solve before says nothing of this point";
}

TEST(Status, NumericalFailureWhereTheGradientLies) {
  // f = x^2 with the slope of -x^2: every step that should go down goes up
  const OneVariable problem(1, [](double x) { return x * x; }, [](double x) { return -2 * x; }, [](double) { return 2.0; });
  on_both_paths(problem, {.max_iterations = 200}, [&](const Traced& run) {
    expect_status(run, Status::numerical_failure);
    expect_last_iterate(problem, run);
    EXPECT_EQ(run.point.x[0], 1);
  });
}

TEST(Status, NumericalFailureWhereADerivativeIsNotANumber) {
  // f = x^4, whose derivatives are lost below 1/2
  for (const bool of_gradient : {true, false}) {
    SCOPED_TRACE(of_gradient ? "gradient" : "Hessian");
    const auto slope = [](double x) { return 4 * x * x * x; };
    const auto curvature = [](double x) { return 12 * x * x; };
    const auto lost_slope = [](double x) { return x < 0.5 ? kNan : 4 * x * x * x; };
    const auto lost_curvature = [](double x) { return x < 0.5 ? kNan : 12 * x * x; };
    OneVariable problem(2, [](double x) { return x * x * x * x; }, slope, curvature);
    if (of_gradient) problem.slope = lost_slope;
    else problem.curvature = lost_curvature;
    on_both_paths(problem, {.max_iterations = 200}, [&](const Traced& run) {
      expect_status(run, Status::numerical_failure);
      expect_last_iterate(problem, run);
      EXPECT_TRUE(std::isfinite(run.result.residual.stationarity)) << "the last accepted iterate has a gradient";
    });
  }
}

TEST(Status, NumericalFailureWhereOneComponentOfManyIsNotANumber) {
  // away from the start the first component of the gradient, or an entry of the Jacobian, is lost: no point there may pass for a solution
  for (const Spoil what : {Spoil::gradient, Spoil::jacobian, Spoil::hessian}) {
    SCOPED_TRACE(static_cast<int>(what));
    const Spoilt<EqualityAndBounds<>> problem(what, [](const auto& x) { return x[1] < 4.85; });
    on_both_paths(problem, {.max_iterations = 200}, [&](const Traced& run) {
      expect_status(run, Status::numerical_failure);
      expect_honest(problem, run);
    });
  }
}

TEST(Derivatives, OfTheFixedSizeProblemsAreRight) {
  const auto check = [](const auto& problem) {
    const AsNlp nlp(problem);
    Vector x(nlp.num_variables());
    nlp.initial_point(x);
    x.array() += 0.3;
    EXPECT_TRUE(check_derivatives(nlp, x, 0.7, Vector::LinSpaced(nlp.num_constraints(), -1, 2)).passed(1e-6));
  };
  check(EqualityAndBounds<>());
  check(TwoSidedRows<>());
  check(NonConvex<>());
  check(FixedVariable<>());
  check(BallAndBox<>());
  check(CurvedEqualities<>());
  check(OpposedRows<>());
  check(SpringRow<>());
  check(Downhill());
  check(BallOfNegativeRadius());
}

}  // namespace
}  // namespace tenon
