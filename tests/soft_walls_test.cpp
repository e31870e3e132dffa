// The pole between soft walls: its model, its horizon, and the closed loop beside exhaustive search over all contact sequences.
#include <gtest/gtest.h>

#include <cstring>

#include "tenon/mpc/receding_horizon.hpp"
#include "tenon/problems/soft_walls/horizon.hpp"
#include "tenon/tests/allocation_counter.hpp"
#include "tenon/tests/soft_walls_runs.hpp"

namespace tenon::soft_walls {
namespace {

const State kStart(0.1, -0.5, 0.5, -0.4);

TEST(SoftWalls, TheWallsForcesSolveTheComplementarityProblem) {
  const Model model;
  const double k = model.parameters().stiffness, w = model.parameters().wall;
  EXPECT_NEAR(model.wall_force(model.tip().dot(kStart)), 5, 1e-12);  // 5 cm inside a wall of 100 N/m
  for (const double p : {-0.6, -0.35, -0.1, 0.0, 0.2, 0.35, 0.5}) {
    const double force = model.wall_force(p), right = std::max(0.0, force), left = std::max(0.0, -force);
    EXPECT_GE(-p + right / k + w, -1e-15);
    EXPECT_GE(p + left / k + w, -1e-15);
    EXPECT_NEAR(right * (-p + right / k + w), 0, 1e-12);
    EXPECT_NEAR(left * (p + left / k + w), 0, 1e-12);
  }
}

TEST(SoftWalls, TheTerminalCostSolvesItsRiccatiEquation) {
  const Model model;
  const Weights weights;
  const Eigen::Matrix4d p = riccati_solution(model, weights), q = weights.state.asDiagonal();
  const Eigen::Matrix4d right = q + model.a().transpose() * p * (model.a() - model.b() * regulator_gain(model, weights, p));
  EXPECT_LE((right - p).norm(), 1e-9 * p.norm());
  const Eigen::Matrix4d closed = model.a() - model.b() * regulator_gain(model, weights, p);
  EXPECT_LT(closed.eigenvalues().cwiseAbs().maxCoeff(), 1);
}

TEST(SoftWalls, TheReferenceAwayFromTheWallsIsTheRegulator) {
  const Model model;
  const State x(0.01, 0.01, 0, 0);
  ExhaustiveSearch search(model, {}, 5);
  EXPECT_NEAR(search.command(x), -regulator_gain(model, {}, riccati_solution(model, {})).dot(x), 1e-9);
}

TEST(SoftWalls, APlanIsTheBestOfAllContactSequences) {
  const Model model;
  const Weights weights;
  constexpr int kIntervals = 5;
  Horizon horizon(model, weights, kIntervals, 1e-4, kStart);  // rounded less than in the task: the law itself is compared
  const auto solver = make_solver("newton-kkt", horizon);
  ExhaustiveSearch search(model, weights, kIntervals);
  Point plan(horizon.num_variables(), horizon.num_constraints());
  for (const State& x : {kStart, State(0.3, -0.2, 0.1, 0.4), State(-0.2, 0.4, -0.9, 0.3), State(0.1, -0.1, 1.2, -1)}) {
    horizon.observe(0, x, Vector());
    horizon.initial_point(plan.x);
    plan.lambda.setZero(), plan.z.setZero();
    const Result result = solver->solve(plan);
    ASSERT_TRUE(succeeded(result.status));
    const double u = search.command(x);
    EXPECT_NEAR(result.objective, search.best_objective(), 1e-3 * search.best_objective());
    EXPECT_NEAR(plan.x[4], u, 1e-2 * std::max(1.0, std::abs(u)));
  }
}

TEST(SoftWalls, FromTheGivenStartTheLoopArrivesWithEitherHorizon) {
  const Outcome five = run_in_world(0, 5), ten = run_in_world(0, 10);
  EXPECT_TRUE(five.arrived);
  EXPECT_TRUE(ten.arrived);
  EXPECT_LT(ten.cost, five.cost) << "a longer horizon sees more of what the walls can do for it";
}

TEST(SoftWalls, FromFiveStartsTheLoopCostsWhatExhaustiveSearchDoes) {
  int arrived = 0;
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const Outcome reference = reference_in_world(seed, 5), own = run_in_world(seed, 5);
    if (!reference.arrived) continue;
    ++arrived;
    EXPECT_TRUE(own.arrived) << "world " << seed;
    EXPECT_TRUE(run_in_world(seed, 10).arrived) << "world " << seed;
    EXPECT_NEAR(own.cost, reference.cost, 0.05 * reference.cost) << "world " << seed;
  }
  EXPECT_GE(arrived, 2);
}

TEST(SoftWalls, ATickAllocatesNothingAndRepeatsBitForBit) {
  ControlTask task = make_task("cart-pole-soft-walls");
  const auto controller =
      take_controller(task, "mpc", [](const Nlp& problem, const Options& options) { return make_solver("newton-kkt", problem, options); });
  std::vector<double> first, second;
  for (std::vector<double>* commands : {&first, &second}) {
    Vector x(4), u(1);
    task.plant->reset(3);
    controller->reset();
    commands->reserve(100);
    for (int k = 0; k < 100; ++k) {
      task.plant->measure(x);
      const AllocationCounter counter;
      controller->update(0.01 * k, x, u);
      EXPECT_EQ(counter.count(), 0) << "tick " << k;
      commands->push_back(u[0]);
      task.plant->advance(0.01 * (k + 1), u);
    }
  }
  EXPECT_EQ(std::memcmp(first.data(), second.data(), first.size() * sizeof(double)), 0);
}

}  // namespace
}  // namespace tenon::soft_walls
