// The receding horizon's decisions, with solvers that do as they are told; then real ones under deadlines and without any feasible plan.
#include "tenon/mpc/receding_horizon.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <deque>

#include "tenon/core/input_error.hpp"
#include "tenon/mpc/closed_loop.hpp"
#include "tenon/mpc/task_controllers.hpp"
#include "tenon/problems/tasks.hpp"
#include "tenon/solvers/make_solver.hpp"
#include "tenon/tests/expect_message.hpp"

namespace tenon {
namespace {

constexpr double kInterval = 0.1;

/// A point of which the input is the speed:  x_k + dt u_k = x_{k+1}, N = 4, |u| <= 1, and x_N at most `end`.
class Walk final : public HorizonProgram {
 public:
  static constexpr int kIntervals = 4;

  int num_measurements() const override { return 1; }
  int num_commands() const override { return 1; }
  double interval() const override { return kInterval; }
  void observe(double, ConstVectorRef measurements, ConstVectorRef) override { start_ = measurements[0]; }
  void commands(const Point& plan, double elapsed, VectorRef commands) const override {
    commands[0] = plan.x[2 * std::min(kIntervals - 1, static_cast<int>(elapsed / kInterval + 1e-6)) + 1];
  }
  int num_variables() const override { return 2 * kIntervals + 1; }
  int num_constraints() const override { return kIntervals; }
  Stages stages() const override {
    Stages stages;
    for (int k = 0; k < kIntervals; ++k) stages.stages.push_back({{2 * k, 2 * k + 2}, {k, k + 1}});
    stages.stages.push_back({{2 * kIntervals, 2 * kIntervals + 1}, {kIntervals, kIntervals}});
    return stages;
  }
  SparsePattern jacobian_pattern() const override {
    std::vector<std::pair<int, int>> entries;
    for (int k = 0; k < kIntervals; ++k) {
      for (const int i : {0, 1, 2}) entries.emplace_back(k, 2 * k + i);
    }
    return SparsePattern::from_entries(num_constraints(), num_variables(), entries);
  }
  SparsePattern hessian_pattern() const override {
    std::vector<std::pair<int, int>> entries;
    for (int i = 0; i < num_variables(); ++i) entries.emplace_back(i, i);
    return SparsePattern::from_entries(num_variables(), num_variables(), entries);
  }
  void bounds(Bounds& bounds) const override {
    bounds.x_lower[0] = bounds.x_upper[0] = start_;
    for (int k = 0; k < kIntervals; ++k) bounds.x_lower[2 * k + 1] = -1, bounds.x_upper[2 * k + 1] = 1;
    bounds.x_upper[2 * kIntervals] = end;
    bounds.c_lower.setZero(), bounds.c_upper.setZero();
  }
  void initial_point(VectorRef x) const override { x.setConstant(start_); }
  double objective(ConstVectorRef x, Workspace&) const override { return x.squaredNorm() / 2; }
  void gradient(ConstVectorRef x, Workspace&, VectorRef gradient) const override { gradient = x; }
  void constraints(ConstVectorRef x, Workspace&, VectorRef values) const override {
    for (int k = 0; k < kIntervals; ++k) values[k] = x[2 * k] + kInterval * x[2 * k + 1] - x[2 * k + 2];
  }
  void jacobian(ConstVectorRef, Workspace&, std::span<double> values) const override {
    double* out = values.data();
    for (int k = 0; k < kIntervals; ++k) {
      if (k > 0) *out++ = -1;
      *out++ = 1;
      *out++ = kInterval;
    }
    *out = -1;
  }
  void hessian(ConstVectorRef, double sigma, ConstVectorRef, Workspace&, std::span<double> values) const override {
    std::fill(values.begin(), values.end(), sigma);
  }

  double end = kInfinity<double>;

 private:
  double start_ = 0;
};

/// How a scripted solve ends, and the value that all of its x then have.
struct Ending {
  Status status = Status::solved;
  double violation = 0, x = 0;
  bool throws = false;
};

/// What happened to the solvers of one controller.
struct Script {
  std::deque<Ending> endings;
  std::vector<bool> was_warm;
  std::vector<Point> starts;

  SolverFactory factory() {
    return [this](const Nlp&, const Options& options) { return std::make_unique<ScriptedSolver>(*this, options.warm_start); };
  }

  class ScriptedSolver final : public Solver {
   public:
    ScriptedSolver(Script& script, bool warm) : script_(script), warm_(warm) {}
    Result solve(Point& point) override {
      const Ending ending = script_.endings.front();
      script_.endings.pop_front();
      script_.was_warm.push_back(warm_);
      script_.starts.push_back(point);
      if (ending.throws) throw std::invalid_argument("bounds cross");
      for (int i = 0; i < point.x.size(); ++i) point.x[i] = ending.x + i;
      point.lambda.setConstant(ending.x);
      Result result;
      result.status = ending.status;
      result.iterations = 7;
      result.residual.primal = ending.violation;
      return result;
    }

   private:
    Script& script_;
    bool warm_;
  };
};

class Decisions : public testing::Test {
 protected:
  /// Of the plan made ahead no use can be made, unless it is given: the first tick begins from nothing.
  RecedingHorizon& make(std::deque<Ending> endings, double period = kInterval, const Ending& ahead = {Status::infeasible, 1}) {
    script_.endings = {ahead};
    controller_ = std::make_unique<RecedingHorizon>(std::make_unique<Walk>(), nullptr, script_.factory(), options_, period);
    script_ = Script();
    script_.endings = std::move(endings);
    return *controller_;
  }
  double update(double t, double x = 0) {
    Vector measured = Vector::Constant(1, x), command(1);
    controller_->update(t, measured, command);
    return command[0];
  }

  HorizonOptions options_;
  Script script_;
  std::unique_ptr<RecedingHorizon> controller_;
};

TEST_F(Decisions, ASolvedPlanIsCommandedFromItsBeginning) {
  const auto& controller = make({{Status::solved, 0, 100}});
  EXPECT_EQ(update(0), 101);
  EXPECT_EQ(controller.last_step().source, PlanSource::solved);
  EXPECT_EQ(controller.last_step().iterations, 7);
}

TEST_F(Decisions, TheLastIterateIsGoodEnoughWhereItsRowsHold) {
  const auto& controller = make({{}, {Status::iteration_limit, 1e-4, 200}, {Status::numerical_failure, 1e-4, 300}});
  update(0);
  EXPECT_EQ(update(0.1), 201);
  EXPECT_EQ(controller.last_step().source, PlanSource::iterate);
  EXPECT_EQ(controller.last_step().status, Status::iteration_limit);
  EXPECT_EQ(update(0.2), 301);
  EXPECT_FALSE(controller.last_step().fell_back());
}

TEST_F(Decisions, APlanWhoseRowsDoNotHoldGivesWayToTheOneBeforeShifted) {
  const auto& controller = make({{Status::solved, 0, 100}, {Status::iteration_limit, 1, 200}, {Status::infeasible, 2, 300}});
  update(0);
  EXPECT_EQ(update(0.1), 103);  // u_1 of the first plan
  EXPECT_EQ(controller.last_step().source, PlanSource::shifted);
  EXPECT_EQ(controller.last_step().violation, 1);
  EXPECT_EQ(update(0.2), 105);
  EXPECT_EQ(controller.last_step().status, Status::infeasible);
}

TEST_F(Decisions, AnIterateThatIsNotFiniteIsNotUsed) {
  const auto& controller = make({{Status::solved, 0, 100}, {Status::solved, 0, std::nan("")}});
  update(0);
  EXPECT_EQ(update(0.1), 103);
  EXPECT_TRUE(controller.last_step().fell_back());
}

TEST_F(Decisions, WhatLastsLongerThanThePlanRepeatsItsLastInput) {
  make({{Status::solved, 0, 100}, {Status::infeasible, 1}, {Status::infeasible, 1}, {Status::infeasible, 1}, {Status::infeasible, 1}});
  update(0);
  for (const double t : {0.1, 0.2, 0.3}) update(t);
  EXPECT_EQ(update(0.4), 107);
}

TEST_F(Decisions, TheFirstSolveIsColdThenWarmAndColdAgainAfterAPlanOfNoUse) {
  make({{}, {Status::solved, 0, 100}, {Status::infeasible, 1}, {Status::solved, 0, 200}, {}});
  for (int k = 0; k < 5; ++k) update(0.1 * k, k);
  EXPECT_EQ(script_.was_warm, (std::vector<bool>{false, true, true, false, true}));
  EXPECT_EQ(script_.starts[3].x, Vector::Constant(9, 3)) << "the program's initial point, of what was observed last";
  EXPECT_EQ(script_.starts[3].lambda, Vector::Zero(4));
}

TEST_F(Decisions, AWarmStartIsTheShiftedPlanWithItsMultipliers) {
  make({{Status::solved, 0, 100}, {}});
  update(0);
  update(0.1);
  Vector shifted(9);
  shifted << 102, 103, 104, 105, 106, 107, 108, 107, 108;
  EXPECT_EQ(script_.starts[1].x, shifted);
  EXPECT_EQ(script_.starts[1].lambda, Vector::Constant(4, 100));
}

TEST_F(Decisions, TicksFasterThanAnIntervalDoNotShift) {
  make({{Status::solved, 0, 100}, {Status::solved, 0, 200}, {Status::infeasible, 1}, {Status::infeasible, 1}, {Status::infeasible, 1}}, 0.04);
  update(0);
  EXPECT_EQ(update(0.04), 201);
  EXPECT_EQ(script_.starts[1].x[0], 100);
  EXPECT_EQ(update(0.08), 201) << "the plan of 0.04 s, in its first interval";
  EXPECT_EQ(update(0.12), 201);
  EXPECT_EQ(update(0.16), 203) << "its second";
}

TEST_F(Decisions, WhatActsLateIsWhatThePlanHasForThen) {
  options_.delay = 2 * kInterval;
  make({{Status::solved, 0, 100}, {Status::infeasible, 1}});
  EXPECT_EQ(update(0), 105);
  EXPECT_EQ(update(kInterval), 107) << "of the shifted plan too";
}

TEST_F(Decisions, WithoutAnyPlanTheInitialPointIsCommanded) {
  const auto& controller = make({{Status::infeasible, 1}, {Status::infeasible, 1}});
  EXPECT_EQ(update(0, 5), 5);
  EXPECT_EQ(controller.last_step().source, PlanSource::initial);
  EXPECT_EQ(update(0.1, 6), 5) << "then that plan, shifted";
  EXPECT_EQ(controller.last_step().source, PlanSource::shifted);
}

TEST_F(Decisions, WhatASolverRefusesIsAFallbackToo) {
  const auto& controller = make({{Status::solved, 0, 100}, {.throws = true}});
  update(0);
  EXPECT_EQ(update(0.1), 103);
  EXPECT_EQ(controller.last_step().status, Status::invalid_start);
  EXPECT_TRUE(controller.last_step().fell_back());
}

TEST_F(Decisions, AfterAResetItIsAsIfJustBuilt) {
  auto& controller = make({{Status::solved, 0, 100}, {Status::infeasible, 1}});
  update(0);
  controller.reset();
  EXPECT_EQ(update(0, 5), 5);
  EXPECT_EQ(script_.was_warm.back(), false);
}

TEST_F(Decisions, TheFirstTickGoesOnFromThePlanMadeAhead) {
  auto& controller = make({{Status::solved, 0, 200}, {Status::solved, 0, 200}}, kInterval, {Status::solved, 0, 100});
  for (int run = 0; run < 2; ++run) {
    controller.reset();
    EXPECT_EQ(update(5), 201) << "whenever the first tick is, the plan made ahead is for it";
    EXPECT_EQ(script_.starts.back().x[0], 100);
    EXPECT_EQ(script_.starts.back().lambda, Vector::Constant(4, 100));
    EXPECT_EQ(controller.plan_start(), 5);
    EXPECT_EQ(controller.last_step().iterations, 7) << "what was planned ahead is no part of a tick";
  }
  EXPECT_EQ(script_.was_warm, (std::vector<bool>{true, true}));
}

TEST_F(Decisions, WhereThePlantIsNotWhereItWasExpectedTheFirstTickStartsAfresh) {
  const auto& controller = make({{Status::iteration_limit, 1, 200}, {Status::solved, 0, 300}}, kInterval, {Status::solved, 0, 100});
  EXPECT_EQ(update(0, 3), 301);
  EXPECT_EQ(script_.was_warm, (std::vector<bool>{true, false}));
  EXPECT_EQ(script_.starts[1].x, Vector::Constant(9, 3));
  EXPECT_EQ(controller.last_step().source, PlanSource::solved);
  EXPECT_EQ(controller.last_step().iterations, 14) << "of both solves";
}

TEST_F(Decisions, ThePlanMadeAheadIsNeverCommandedToAPlantItWasNotMadeFor) {
  const auto& controller = make({{Status::infeasible, 1}, {Status::infeasible, 1}}, kInterval, {Status::solved, 0, 100});
  EXPECT_EQ(update(0, 5), 5) << "the initial point of what was observed";
  EXPECT_EQ(controller.last_step().source, PlanSource::initial);
}

TEST_F(Decisions, ADelayIsNotNegative) {
  options_.delay = -kInterval;
  EXPECT_MESSAGE(make({}), std::invalid_argument, "at least 0");
}

TEST_F(Decisions, APeriodLongerThanAStageIsRefused) {
  EXPECT_MESSAGE(make({}, 0.2), std::invalid_argument, "at most a stage, 0.1");
  EXPECT_MESSAGE(make({}, 0), std::invalid_argument, "more than 0");
}

std::unique_ptr<Solver> newton(const Nlp& problem, const Options& options) { return make_solver("newton-kkt", problem, options); }

TEST(RecedingHorizon, WalksHome) {
  RecedingHorizon controller(std::make_unique<Walk>(), nullptr, &newton, {}, kInterval);
  Vector x = Vector::Constant(1, 3), u(1);
  for (int k = 0; k < 100; ++k) {
    controller.update(kInterval * k, x, u);
    EXPECT_LE(std::abs(u[0]), 1 + 1e-6);
    x[0] += kInterval * u[0];
  }
  EXPECT_NEAR(x[0], 0, 0.1);  // so short a horizon is in no hurry
}

TEST(RecedingHorizon, AHorizonWithoutAnyPlanNeverStopsIt) {
  auto walk = std::make_unique<Walk>();
  Walk& program = *walk;
  RecedingHorizon controller(std::move(walk), nullptr, &newton, {}, kInterval);
  Vector x = Vector::Constant(1, 3), u(1);
  int fallbacks = 0;
  for (int k = 0; k < 60; ++k) {
    program.end = k >= 10 && k < 20 ? -10 : kInfinity<double>;  // a place that is out of reach, for a second
    controller.update(kInterval * k, x, u);
    ASSERT_TRUE(std::isfinite(u[0]));
    ASSERT_LE(std::abs(u[0]), 1 + 1e-6);
    fallbacks += controller.last_step().fell_back();
    x[0] += kInterval * u[0];
  }
  EXPECT_EQ(fallbacks, 10);
  EXPECT_NEAR(x[0], 0, 0.5);
}

TEST(RecedingHorizon, AMeasurementThatIsNoNumberDoesNotStopIt) {
  RecedingHorizon controller(std::make_unique<Walk>(), nullptr, &newton, {}, kInterval);
  Vector x = Vector::Constant(1, 3), u(1);
  controller.update(0, x, u);
  const double planned = controller.plan().x[3];
  x[0] = std::nan("");
  controller.update(kInterval, x, u);
  EXPECT_TRUE(controller.last_step().fell_back());
  EXPECT_EQ(u[0], planned);
  x[0] = 2.8;
  controller.update(2 * kInterval, x, u);
  EXPECT_EQ(controller.last_step().source, PlanSource::solved);
}

TEST(RecedingHorizon, ADeadlineThatHasPassedLeavesThePlanBefore) {
  HorizonOptions options;
  options.warm.time_limit = 0;
  options.warm.tolerance = 1e-12;
  options.largest_violation = 1e-9;
  RecedingHorizon controller(std::make_unique<Walk>(), nullptr, &newton, options, kInterval);
  Vector x = Vector::Constant(1, 3), u(1);
  controller.update(0, x, u);
  EXPECT_EQ(controller.last_step().source, PlanSource::solved);
  x[0] = 2.7;  // not where the plan has it
  controller.update(kInterval, x, u);
  EXPECT_EQ(controller.last_step().status, Status::time_limit);
  EXPECT_TRUE(std::isfinite(u[0]));
}

TEST(ClosedLoop, ARowOfASweepDependsOnItsSeedAlone) {
  const auto experiment = [] {
    ControlTask task = make_task("delta-touch-down", {"duration=0.4"});
    auto controller = take_controller(task, "mpc", &newton);
    return std::make_unique<ClosedLoopExperiment>(std::move(task.plant), std::move(controller), task.duration);
  };
  const auto one = experiment(), other = experiment();
  const std::vector<std::string> names = one->names();
  EXPECT_EQ(std::count(names.begin(), names.end(), "success"), 1);
  EXPECT_EQ(names.back(), "fallbacks");
  Vector first(names.size()), again(names.size());
  one->run(5, first);
  for (const std::uint64_t seed : {9u, 2u}) other->run(seed, again);
  other->run(5, again);
  EXPECT_EQ(first, again);
  EXPECT_EQ(first[first.size() - 3], 40) << "steps";
}

TEST(ClosedLoop, ScrambledTruthLeavesEveryCommandAsItIs) {
  // The record's truth is not what the controller is given: it sees the measurements alone.
  ControlTask task = make_task("delta-touch-down", {"duration=0.3"});
  const auto controller = take_controller(task, "mpc", &newton);
  ClosedLoop loop(*task.plant, *controller, task.duration);
  const std::vector<std::string> columns = loop.columns();
  const auto column = [&](const std::string& name) { return std::find(columns.begin(), columns.end(), name) - columns.begin(); };
  std::vector<std::vector<double>> commands(2);
  for (const std::uint64_t seed : {1, 2}) {  // worlds that differ in the plane alone, which is not reached in this time
    loop.run(seed, [&](const Vector& row) {
      commands[seed - 1].push_back(row[column("w")]);
      return true;
    });
  }
  EXPECT_EQ(commands[0], commands[1]);
}

TEST(Tasks, AControllerIsAskedForByName) {
  ControlTask task = make_task("delta-touch-down");
  EXPECT_EQ(controller_names(task), (std::vector<std::string>{"mpc", "tracking", "pair"}));
  EXPECT_MESSAGE(take_controller(task, "trackin", &newton), std::invalid_argument, "nearest is 'tracking'");
}

TEST(Tasks, AFileThatMakesNoSenseSaysWhere) {
  EXPECT_MESSAGE(make_task("delta-touch-dwn"), std::invalid_argument, "nearest is 'delta-touch-down'");
  EXPECT_MESSAGE(make_task("delta-touch-down", {"masss=1"}), InputError, "nearest known key is 'mass'");
  EXPECT_MESSAGE(make_task("delta-touch-down", {"mass=-1"}), InputError, "mass is -1");
  EXPECT_MESSAGE(make_task("delta-touch-down", {"contact=glue"}), InputError, "gap or pair");
  EXPECT_MESSAGE(make_task("delta-touch-down", {"start=0.5"}), InputError, "start < plane");
  EXPECT_MESSAGE(make_task("cart-pole-soft-walls", {"intervals=0"}), InputError, "1 or more");
  EXPECT_MESSAGE(make_task("cart-pole-soft-walls", {"weights.state=[1, 2, 3]"}), InputError, "weights.state");
}

}  // namespace
}  // namespace tenon
