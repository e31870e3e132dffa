// Newton-KKT on its two storage paths, fixed size and sparse: they take the same iterates, agree with Ipopt, allocate nothing, repeat bit
// for bit, and end at once where they start from the answer.
#include <gtest/gtest.h>

#include "tenon/solvers/make_solver.hpp"
#include "tenon/tests/allocation_counter.hpp"
#include "tenon/tests/fixed_size_problems.hpp"
#include "tenon/tests/newton_runs.hpp"

namespace tenon {
namespace {

template <class P>
class BothPaths : public testing::Test {};
using Problems =
    testing::Types<EqualityAndBounds<>, TwoSidedRows<>, NonConvex<>, FixedVariable<>, BallAndBox<>, CurvedEqualities<>, SpringRow<>>;
TYPED_TEST_SUITE(BothPaths, Problems);

void expect_close(double a, double b, double tolerance, const char* what, int line) {
  EXPECT_LE(std::abs(a - b), tolerance * (1 + std::abs(b))) << what << " of iterate " << line << ": " << a << " and " << b;
}

TYPED_TEST(BothPaths, TakeTheSameIterates) {
  const TypeParam problem;
  const Traced dense = run_dense(problem), sparse = run_sparse(problem);
  EXPECT_EQ(dense.result.status, Status::solved);
  EXPECT_EQ(sparse.result.status, Status::solved);
  ASSERT_EQ(dense.result.iterations, sparse.result.iterations);
  ASSERT_EQ(dense.trace.size(), sparse.trace.size());
  for (std::size_t k = 0; k + 1 < dense.trace.size(); ++k) {
    const Iteration &a = dense.trace[k], &b = sparse.trace[k];
    const int line = static_cast<int>(k);
    EXPECT_EQ(a.index, b.index);
    EXPECT_EQ(a.trials, b.trials) << line;
    expect_close(a.objective, b.objective, 1e-10, "objective", line);
    expect_close(a.primal, b.primal, 1e-10, "primal", line);
    expect_close(a.dual, b.dual, 1e-10, "dual", line);
    expect_close(a.complementarity, b.complementarity, 1e-10, "complementarity", line);
    expect_close(a.mu, b.mu, 1e-10, "mu", line);
    expect_close(a.alpha_primal, b.alpha_primal, 1e-10, "alpha_primal", line);
    expect_close(a.alpha_dual, b.alpha_dual, 1e-10, "alpha_dual", line);
    expect_close(a.regularization, b.regularization, 1e-10, "regularization", line);
  }
}

TYPED_TEST(BothPaths, AgreeWithIpoptOnVariablesAndMultipliers) {
  for (const SolverDescription& solver : list_solvers()) {
    if (solver.name == "ipopt" && !solver.available) GTEST_SKIP();
  }
  const TypeParam problem;
  const Traced dense = run_dense(problem), sparse = run_sparse(problem), ipopt = run_back_end("ipopt", problem);
  ASSERT_EQ(ipopt.result.status, Status::solved);
  for (const Traced* run : {&dense, &sparse}) {
    EXPECT_LE((run->point.x - ipopt.point.x).template lpNorm<Eigen::Infinity>(), 1e-6) << run->point.x.transpose();
    EXPECT_LE((run->point.lambda - ipopt.point.lambda).template lpNorm<Eigen::Infinity>(), 1e-5) << run->point.lambda.transpose();
    EXPECT_LE((run->point.z - ipopt.point.z).template lpNorm<Eigen::Infinity>(), 1e-5) << run->point.z.transpose();
  }
}

void expect_equal(const std::vector<Iteration>& first, const std::vector<Iteration>& second) {
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t k = 0; k < first.size(); ++k) {
    const Iteration &a = first[k], &b = second[k];
    EXPECT_TRUE(a.index == b.index && a.objective == b.objective && a.primal == b.primal && a.dual == b.dual && a.trials == b.trials &&
                a.complementarity == b.complementarity && a.mu == b.mu && a.alpha_primal == b.alpha_primal &&
                a.alpha_dual == b.alpha_dual && a.regularization == b.regularization)
        << k;
  }
}

/// Solves twice from the same start: without an allocation, and bitwise the same.
template <class Solver, class AnyPoint>
void expect_repeats_without_allocation(Solver& solver, const AnyPoint& start, std::vector<Iteration>& trace) {
  AnyPoint first = start, second = start;
  AllocationCounter of_first;
  const Result one = solver.solve(first);
  EXPECT_EQ(of_first.count(), 0);
  const std::vector<Iteration> trace_of_first = trace;
  trace.clear();
  AllocationCounter of_second;
  const Result two = solver.solve(second);
  EXPECT_EQ(of_second.count(), 0);

  EXPECT_EQ(one.status, Status::solved);
  EXPECT_EQ(one.status, two.status);
  EXPECT_EQ(one.iterations, two.iterations);
  EXPECT_EQ(one.objective, two.objective);
  EXPECT_EQ(one.residual.max(), two.residual.max());
  EXPECT_EQ(first.x, second.x);
  EXPECT_EQ(first.lambda, second.lambda);
  EXPECT_EQ(first.z, second.z);
  expect_equal(trace_of_first, trace);
}

TYPED_TEST(BothPaths, SolveWithoutAllocationAndRepeatBitForBit) {
  const TypeParam problem;
  std::vector<Iteration> trace;
  {
    SCOPED_TRACE("fixed size");
    NewtonKkt<TypeParam> solver(problem, tracing({}, trace));
    expect_repeats_without_allocation(solver, start_of(problem), trace);
  }
  SCOPED_TRACE("sparse");
  const AsNlp<TypeParam> nlp(problem);
  NewtonKkt<Nlp> solver(nlp, tracing({}, trace));
  Point start(TypeParam::kVariables, TypeParam::kConstraints);
  nlp.initial_point(start.x);
  expect_repeats_without_allocation(solver, start, trace);
}

TYPED_TEST(BothPaths, ResolveFromTheAnswerInTwoIterations) {
  const TypeParam problem;
  const Traced cold = run_dense(problem);
  ASSERT_EQ(cold.result.status, Status::solved);
  NewtonKkt<TypeParam> dense(problem, {.warm_start = true});
  PointOf<TypeParam> fixed;
  fixed.x = cold.point.x, fixed.lambda = cold.point.lambda, fixed.z = cold.point.z;
  const Result warm = dense.solve(fixed);
  EXPECT_EQ(warm.status, Status::solved);
  EXPECT_LE(warm.iterations, 2) << "fixed size; cold: " << cold.result.iterations;

  const AsNlp<TypeParam> nlp(problem);
  Point point = cold.point;
  const Result sparse = make_solver("newton-kkt", nlp, {.warm_start = true})->solve(point);
  EXPECT_EQ(sparse.status, Status::solved);
  EXPECT_LE(sparse.iterations, 2) << "sparse";
}

}  // namespace
}  // namespace tenon
