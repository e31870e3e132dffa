// Newton-KKT on problems with stages: the stage-structured kind takes the iterates of the sparse one, whatever the problem asks of it,
// solves every horizon, allocates nothing and repeats bit for bit.
#include <gtest/gtest.h>

#include "tenon/core/with_soft_rows.hpp"
#include "tenon/problems/optimal_control/linear_quadratic.hpp"
#include "tenon/problems/optimal_control/swing_up.hpp"
#include "tenon/tests/allocation_counter.hpp"
#include "tenon/tests/newton_runs.hpp"

namespace tenon {
namespace {

/// A cart of 1 kg from rest to rest over 1 m with |u| <= 1 N in the least time T, N intervals: T is a global variable.
///
///     min  T + 1e-3 sum u^2     s.t.   p + h v = p+,   v + h u = v+,   h = T/N,   p_N = 1,  v_N = 0
///
/// The ends are rows. `repeated` states each of them twice.
class LeastTime final : public Nlp {
 public:
  explicit LeastTime(bool repeated) : repeated_(repeated) {}
  static constexpr int kIntervals = 10;

  int num_variables() const override { return 3 * kIntervals + 3; }
  int num_constraints() const override { return 2 * kIntervals + (repeated_ ? 4 : 2); }
  Stages stages() const override {
    Stages stages;
    for (int k = 0; k < kIntervals; ++k) stages.stages.push_back({{3 * k, 3 * k + 3}, {2 * k, 2 * k + 2}});
    stages.stages.push_back({{3 * kIntervals, kT}, {2 * kIntervals, num_constraints()}});
    stages.globals = {kT, kT + 1};
    return stages;
  }
  SparsePattern jacobian_pattern() const override {
    return SparsePattern::from_entries(num_constraints(), num_variables(), jacobian_entries());
  }
  SparsePattern hessian_pattern() const override {
    std::vector<std::pair<int, int>> entries = {{kT, kT}};
    for (int k = 0; k < kIntervals; ++k) {
      entries.emplace_back(3 * k + 2, 3 * k + 2);
      entries.emplace_back(kT, 3 * k + 1), entries.emplace_back(kT, 3 * k + 2);
    }
    return SparsePattern::from_entries(num_variables(), num_variables(), entries);
  }
  void bounds(Bounds& bounds) const override {
    bounds.x_lower.head(2).setZero(), bounds.x_upper.head(2).setZero();
    for (int k = 0; k < kIntervals; ++k) bounds.x_lower[3 * k + 2] = -1, bounds.x_upper[3 * k + 2] = 1;
    bounds.x_lower[kT] = 0.1, bounds.x_upper[kT] = 10;
    bounds.c_lower.setZero();
    for (int r = 2 * kIntervals; r < num_constraints(); r += 2) bounds.c_lower[r] = 1;
    bounds.c_upper = bounds.c_lower;
  }
  void initial_point(VectorRef x) const override {
    x.setZero();
    x[kT] = 3;
  }
  double objective(ConstVectorRef x, Workspace&) const override {
    double effort = 0;
    for (int k = 0; k < kIntervals; ++k) effort += x[3 * k + 2] * x[3 * k + 2];
    return x[kT] + 1e-3 * effort;
  }
  void gradient(ConstVectorRef x, Workspace&, VectorRef gradient) const override {
    gradient.setZero();
    for (int k = 0; k < kIntervals; ++k) gradient[3 * k + 2] = 2e-3 * x[3 * k + 2];
    gradient[kT] = 1;
  }
  void constraints(ConstVectorRef x, Workspace&, VectorRef values) const override {
    const double h = x[kT] / kIntervals;
    for (int k = 0; k < kIntervals; ++k) {
      for (int r = 0; r < 2; ++r) values[2 * k + r] = x[3 * k + r] + h * x[3 * k + r + 1] - x[3 * k + 3 + r];
    }
    for (int r = 2 * kIntervals; r < num_constraints(); ++r) values[r] = x[3 * kIntervals + r % 2];
  }
  void jacobian(ConstVectorRef x, Workspace&, std::span<double> values) const override {
    SparseMatrix matrix = jacobian_pattern().zero_matrix();
    for (int k = 0; k < kIntervals; ++k) {
      for (int r = 0; r < 2; ++r) {
        matrix.coeffRef(2 * k + r, 3 * k + r) = 1;
        matrix.coeffRef(2 * k + r, 3 * k + r + 1) = x[kT] / kIntervals;
        matrix.coeffRef(2 * k + r, 3 * k + 3 + r) = -1;
        matrix.coeffRef(2 * k + r, kT) = x[3 * k + r + 1] / kIntervals;
      }
    }
    for (int r = 2 * kIntervals; r < num_constraints(); ++r) matrix.coeffRef(r, 3 * kIntervals + r % 2) = 1;
    std::copy_n(matrix.valuePtr(), values.size(), values.begin());
  }
  void hessian(ConstVectorRef, double sigma, ConstVectorRef lambda, Workspace&, std::span<double> values) const override {
    SparseMatrix matrix = hessian_pattern().zero_matrix();
    for (int k = 0; k < kIntervals; ++k) {
      matrix.coeffRef(3 * k + 2, 3 * k + 2) = 2e-3 * sigma;
      for (int r = 0; r < 2; ++r) matrix.coeffRef(kT, 3 * k + r + 1) += lambda[2 * k + r] / kIntervals;
    }
    std::copy_n(matrix.valuePtr(), values.size(), values.begin());
  }

 private:
  static constexpr int kT = 3 * kIntervals + 2;
  std::vector<std::pair<int, int>> jacobian_entries() const {
    std::vector<std::pair<int, int>> entries;
    for (int k = 0; k < kIntervals; ++k) {
      for (int r = 0; r < 2; ++r) {
        for (const int column : {3 * k + r, 3 * k + r + 1, 3 * k + 3 + r, kT}) entries.emplace_back(2 * k + r, column);
      }
    }
    for (int r = 2 * kIntervals; r < num_constraints(); ++r) entries.emplace_back(r, 3 * kIntervals + r % 2);
    return entries;
  }

  bool repeated_;
};

/// The ends may be missed: the first at a price that is worth it, the second at one that is not.
class SoftEnds final : public NlpDecorator {
 public:
  using NlpDecorator::NlpDecorator;
  std::vector<SoftRow> soft_rows() const override {
    return {{.row = 2 * LeastTime::kIntervals + 1, .linear = 10}, {.row = 2 * LeastTime::kIntervals, .linear = 0.5, .quadratic = 1}};
  }
};

template <class Kkt, class P>
Traced run_with(const P& problem, const Options& options = {}) {
  Traced run{Point(problem.num_variables(), problem.num_constraints()), {}, {}};
  problem.initial_point(run.point.x);
  NewtonKkt<P, Kkt> solver(problem, tracing(options, run.trace));
  run.result = solver.solve(run.point);
  return run;
}

void expect_same_iterates(const Traced& stage, const Traced& sparse) {
  EXPECT_EQ(stage.result.status, Status::solved);
  EXPECT_EQ(sparse.result.status, Status::solved);
  ASSERT_EQ(stage.trace.size(), sparse.trace.size());
  for (std::size_t k = 0; k + 1 < stage.trace.size(); ++k) {
    const Iteration &a = stage.trace[k], &b = sparse.trace[k];
    const auto expect_close = [&](double of_a, double of_b, const char* what) {
      EXPECT_LE(std::abs(of_a - of_b), 1e-10 * (1 + std::abs(of_b))) << what << " of iterate " << k << ": " << of_a << " and " << of_b;
    };
    EXPECT_EQ(a.trials, b.trials) << k;
    expect_close(a.objective, b.objective, "objective");
    expect_close(a.primal, b.primal, "primal");
    expect_close(a.mu, b.mu, "mu");
    expect_close(a.alpha_primal, b.alpha_primal, "alpha_primal");
    expect_close(a.alpha_dual, b.alpha_dual, "alpha_dual");
    expect_close(a.regularization, b.regularization, "regularization");
  }
  EXPECT_LE((stage.point.x - sparse.point.x).lpNorm<Eigen::Infinity>(), 1e-8);
}

TEST(StagePath, TakesTheIteratesOfTheSparsePath) {
  const SwingUp tracking(pendulum());
  expect_same_iterates(run_with<KktOf<SwingUp>>(tracking), run_with<SparseKkt>(tracking));
  const LinearQuadratic<6, 3> chain(mass_spring_chain(6, 3, 20));
  expect_same_iterates(run_with<KktOf<LinearQuadratic<6, 3>>>(chain), run_with<SparseKkt>(chain));
  const SwingUp swing_up(cart_pole(20));
  expect_same_iterates(run_with<KktOf<SwingUp>>(swing_up), run_with<SparseKkt>(swing_up));
}

TEST(StagePath, TakesThemWithAGlobalVariableAndRowsAtTheEnd) {
  const LeastTime problem(false);
  const Traced stage = run_with<StageKkt<>>(problem);
  expect_same_iterates(stage, run_with<SparseKkt>(problem));
  EXPECT_LT(stage.point.x.tail<1>()[0], 2.2);  // 2 s in continuous time
}

TEST(StagePath, KeepsTheSlacksOfSoftRowsInTheirStages) {
  const LeastTime hard(false);
  const SoftEnds soft(hard);
  const WithSoftRows problem(soft);
  EXPECT_EQ(problem.stages().stages.back().slacks, (IndexRange{problem.num_variables() - 4, problem.num_variables()}));
  const Traced stage = run_with<StageKkt<>>(problem);
  expect_same_iterates(stage, run_with<SparseKkt>(problem));
  EXPECT_GT(stage.point.x.tail<4>().maxCoeff(), 1e-3) << "the first end is missed";
  EXPECT_LE(stage.point.x.tail<2>().maxCoeff(), 1e-6) << "the second is not";
}

TEST(StagePath, SurvivesRowsStatedTwice) {
  const LeastTime once(false), twice(true);
  const Traced a = run_with<StageKkt<>>(once), b = run_with<StageKkt<>>(twice);
  EXPECT_EQ(b.result.status, Status::solved);
  EXPECT_NEAR(a.result.objective, b.result.objective, 1e-7);
}

TEST(StagePath, SolvesEveryHorizonToTheKnownOptimum) {
  for (const int intervals : {50, 100, 200, 300, 1000}) {
    const SwingUp problem(cart_pole(intervals));
    const Traced run = run_with<KktOf<SwingUp>>(problem);
    EXPECT_EQ(run.result.status, Status::solved) << intervals;
    if (intervals != 100) continue;
    const double nearest = std::min(std::abs(run.result.objective - 11181.3177), std::abs(run.result.objective - 11190.6966));
    EXPECT_LE(nearest, 1e-3);
  }
}

TEST(StagePath, ConvergesWithTheGaussNewtonHessianToo) {
  // as a controller does: from the plan of another start. From the very first guess the two Hessians may lead to different optima.
  SwingUpProgram program = pendulum();
  const SwingUp exact(program);
  PointOf<SwingUp> point = run_with<KktOf<SwingUp>>(exact).point;
  point.x.array() += 0.01;
  program.gauss_newton = true;
  const SwingUp problem(program);
  Options options;
  options.warm_start = true;
  NewtonKkt<SwingUp> solver(problem, options);
  const Result result = solver.solve(point);
  EXPECT_EQ(result.status, Status::solved);
  EXPECT_NEAR(result.objective, 2242.828131, 1e-4);
}

TEST(StagePath, IsWhatTheBackEndTakesForProblemsWithStages) {
  const SwingUp problem(pendulum());
  const Traced own = run_with<KktOf<SwingUp>>(problem);
  Point point(problem.num_variables(), problem.num_constraints());
  problem.initial_point(point.x);
  make_solver("newton-kkt", problem, {.scaling = false})->solve(point);
  EXPECT_EQ(point.x, own.point.x);
}

TEST(StagePath, AllocatesNothingAndRepeatsBitForBit) {
  const SwingUp problem(cart_pole(50));
  NewtonKkt<SwingUp> solver(problem);
  Vector first;
  for (int run = 0; run < 2; ++run) {
    Point point(problem.num_variables(), problem.num_constraints());
    problem.initial_point(point.x);
    AllocationCounter counter;
    const Result result = solver.solve(point);
    EXPECT_EQ(counter.count(), 0);
    EXPECT_EQ(result.status, Status::solved);
    if (run == 0) first = point.x;
    EXPECT_EQ(point.x, first);
  }
}

}  // namespace
}  // namespace tenon
