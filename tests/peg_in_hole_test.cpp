// A peg and its hole: gaps that are right everywhere, plans that both solvers find, closed loops that end in the hole.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tenon/core/input_error.hpp"
#include "tenon/mpc/closed_loop.hpp"
#include "tenon/mpc/task_controllers.hpp"
#include "tenon/problems/peg_in_hole/assembly_program.hpp"
#include "tenon/problems/peg_in_hole/channels.hpp"
#include "tenon/problems/peg_in_hole/plant.hpp"
#include "tenon/problems/tasks.hpp"
#include "tenon/tests/allocation_counter.hpp"
#include "tenon/tests/expect_message.hpp"
#include "tenon/tests/solved.hpp"

namespace tenon::peg {
namespace {

constexpr int kStage = 21;  // variables of an interval

std::unique_ptr<Solver> newton_kkt(const Nlp& problem, const Options& options) {
  return make_solver("newton-kkt", problem, options);
}

Vector3d random_pose(std::mt19937& random, const Vector3d& half_width) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  return {half_width[0] * uniform(random), half_width[1] * uniform(random), half_width[2] * uniform(random)};
}

TEST(PegGeometry, ASmoothGapLiesAboveTheExactOneByAtMostItsSmoothing) {
  const Geometry geometry;
  constexpr double kDelta = 0.02;
  std::mt19937 random(7);
  for (int sample = 0; sample < 2000; ++sample) {
    const Vector3d pose = random_pose(random, {12, 25, 4}), hole = random_pose(random, {2, 1, 1});
    const auto gaps = exact_gaps(geometry, pose, hole);
    const auto smoothed = smooth_gaps(geometry, kDelta, pose, hole);
    for (std::size_t i = 0; i < kContacts; ++i) {
      const double exact = gaps[i].value, smooth = smoothed[i].value;
      EXPECT_GE(smooth, exact);
      EXPECT_LE(smooth, exact + kDelta);  // two roundings of delta/2 each
    }
  }
}

TEST(PegGeometry, AGapIsNegativeWhereACornerIsInsideTheOtherBody) {
  const Geometry geometry;
  const Vector3d hole(0, 0, 0);
  const auto least = [&](const Vector3d& pose) {
    double gap = 1e9;
    for (const ExactGap& each : exact_gaps(geometry, pose, hole)) gap = std::min(gap, each.value);
    return gap;
  };
  EXPECT_NEAR(least({0, 5, 0}), 5, 1e-12) << "above the mouth: the chamfers' upper edges are the nearest";
  EXPECT_NEAR(least({0, -10, 0}), 0.1, 1e-12) << "inside: half of the clearance";
  EXPECT_NEAR(least({0.15, -10, 0}), -0.05, 1e-12) << "into the right wall";
  EXPECT_NEAR(least({1.6, -0.2, 0}), -0.2, 1e-12) << "into the flat beside the chamfer";
  EXPECT_NEAR(least({0.6, -0.5, 0}), 0, 1e-12) << "on the chamfer";
}

TEST(PegGeometry, WorkOfAContactIsForceTimesGapRate) {
  const Geometry geometry;
  std::mt19937 random(11);
  for (int sample = 0; sample < 200; ++sample) {
    const Vector3d pose = random_pose(random, {2, 15, 2}), hole = random_pose(random, {1, 0.5, 0.7}), rate = random_pose(random, {1, 1, 1});
    constexpr double kStep = 1e-6;
    const auto before = exact_gaps(geometry, pose, hole), after = exact_gaps(geometry, pose + kStep * rate, hole);
    for (std::size_t i = 0; i < before.size(); ++i) {
      const ExactGap &now = before[i], &later = after[i];
      EXPECT_NEAR((later.value - now.value) / kStep, now.normal.dot(rate), 1e-5);
      EXPECT_NEAR(now.normal.head<2>().dot(now.tangent.head<2>()), 0, 1e-14);
    }
  }
}

struct PlanEnd {
  Vector3d pose;
  double largest_spring = 0, largest_product = 0;
};

PlanEnd end_of(const Vector& x, const AssemblyProblem& problem) {
  PlanEnd end{x.segment<3>(kStage * problem.intervals)};
  for (int k = 0; k <= problem.intervals; ++k) {
    const Vector3d spring = problem.impedance.stiffness.cwiseProduct(x.segment<3>(kStage * k + 6));
    end.largest_spring = std::max(end.largest_spring, spring.head<2>().norm());
  }
  return end;
}

TEST(PegProgram, ASinglePlanSlidesOverTheChamferIntoTheHole) {
  const AssemblyProblem problem = single_plan();
  const AssemblyProgram program(problem);
  const Solved solved = tenon::solve(program);
  ASSERT_EQ(solved.result.status, Status::solved);
  const PlanEnd end = end_of(solved.point.x, problem);
  EXPECT_GE(depth(problem.geometry, end.pose, problem.hole), 19.8);
  EXPECT_NEAR(end.pose[0], 1.145, 0.01) << "a prototype's plan ends there";
  EXPECT_LE(end.largest_spring, 3) << "2.3 N in the prototype";
}

TEST(PegProgram, IpoptFindsThePlanToo) {
  const auto solvers = list_solvers();
  if (std::ranges::none_of(solvers, [](const auto& s) { return s.name == "ipopt" && s.available; })) GTEST_SKIP() << "no Ipopt here";
  AssemblyProblem problem;  // one horizon, 2 mm above the hole
  problem.pose = {0.4, 2, 0.1};
  const AssemblyProgram program(problem);
  const Solved ours = tenon::solve(program), theirs = tenon::solve(program, "ipopt");
  ASSERT_EQ(ours.result.status, Status::solved);
  ASSERT_TRUE(succeeded(theirs.result.status));
  // The objective is of the order of 1e-3 and flat: to a tolerance of 1e-8 forces and rates are known to some 1e-3 N and 0.1 mm/s.
  EXPECT_NEAR(ours.result.objective, theirs.result.objective, 1e-6);
  EXPECT_LE((ours.point.x - theirs.point.x).lpNorm<Eigen::Infinity>(), 5e-3);
}

TEST(PegProgram, NothingPushesFromAfar) {
  const AssemblyProblem problem = single_plan();
  const AssemblyProgram program(problem);
  const Solved solved = tenon::solve(program);
  Vector rows(program.num_constraints());
  Nlp::Workspace workspace = program.make_workspace();
  program.prepare(solved.point.x, workspace);
  program.constraints(solved.point.x, workspace, rows);
  for (int k = 0; k < problem.intervals; ++k) {
    const Vector gaps = rows.segment(24 * k + 12, kContacts), forces = solved.point.x.segment(kStage * k + 15, kContacts);
    EXPECT_GE(gaps.minCoeff(), -1e-6);
    EXPECT_LE(gaps.cwiseProduct(forces).maxCoeff(), problem.complementarity + 1e-6);
  }
}

Vector measured(const Vector3d& pose, const Vector3d& reference, const Vector3d& reference_rate) {
  Vector y = Vector::Zero(kMeasurements);
  y.segment<3>(kMeasuredPose) = to_si(pose, 20);
  y.segment<3>(kMeasuredReference) = to_si(reference, 20);
  y.segment<3>(kMeasuredRate) = to_si(reference_rate, 20);
  return y;
}

TEST(PegProgram, CommandsBeginAtTheReferenceAndKeepItsRateWithinLimits) {
  const AssemblyProblem problem;
  AssemblyProgram program(problem);
  const Vector3d reference(0.3, 2.8, 0.05);
  program.observe(0, measured({0.2, 3, 0}, reference, {0, -25, 0}), Vector::Zero(3));
  const Solved solved = tenon::solve(program);
  Vector commands(kCommands);
  program.commands(solved.point, 0, commands);
  EXPECT_LE((commands.segment<3>(kReference) - to_si(reference, 20)).norm(), 1e-12);
  for (double t = 0; t < 0.3; t += 0.003) {
    program.commands(solved.point, t, commands);
    EXPECT_LE(commands.segment<2>(kReferenceRate).lpNorm<Eigen::Infinity>(), 1e-3 * problem.largest_rate * (1 + 1e-6));
  }
  program.commands(solved.point, 1, commands);
  EXPECT_EQ(commands.segment<3>(kReferenceRate).norm(), 0) << "beyond the plan the reference holds still";
}

TEST(PegProgram, ItsInitialPointObeysTheDynamicsAndGoesRoundTheBlocks) {
  constexpr int kDynamics = 12, kRows = 24;
  AssemblyProblem problem;
  problem.pose = {1.8, 0.05, 0.3};  // over the flat beside the hole
  const AssemblyProgram program(problem);
  Vector x(program.num_variables()), rows(program.num_constraints());
  program.initial_point(x);
  auto workspace = program.make_workspace();
  program.prepare(x, workspace);
  program.constraints(x, workspace, rows);
  for (int k = 0; k < problem.intervals; ++k) {
    EXPECT_LE(rows.segment<kDynamics>(kRows * k).lpNorm<Eigen::Infinity>(), 1e-12) << "interval " << k;
    for (const ExactGap& gap : exact_gaps(problem.geometry, x.segment<3>(kStage * (k + 1)), problem.hole))
      EXPECT_GE(gap.value, -1e-12) << "at the end of interval " << k;
  }
  EXPECT_LT(x[kStage * problem.intervals + 1], -1) << "and into the hole";
}

TEST(PegProgram, AsksForAFreshStartOnceThePegIsJammed) {
  AssemblyProgram program{AssemblyProblem{}};
  const Vector y = measured({0, -3, 0}, {0, -3.5, 0}, {0, 0, 0});
  int asked = 0;
  for (int tick = 0; tick <= 50; ++tick) {
    program.observe(0.01 * tick, y, Vector::Zero(3));
    asked += program.wants_fresh_start();
    EXPECT_TRUE(tick > 15 || asked == 0) << "not before 0.15 s";
  }
  EXPECT_EQ(asked, 3) << "once every 0.16 s";
  program.observe(0, y, Vector::Zero(3));
  EXPECT_FALSE(program.wants_fresh_start()) << "a new run begins";
}

TEST(PegProgram, AsksForAFreshStartWhereTheHoleTurnsOutToBeElsewhere) {
  AssemblyProgram program{AssemblyProblem{}};
  const auto asks = [&](double t, double hole_x) {
    program.observe(t, measured({0, 5 - 25 * t, 0}, {0, 5 - 25 * t, 0}, {0, 0, 0}), Vector3d(1e-3 * hole_x, 0, 0));
    return program.wants_fresh_start();
  };
  EXPECT_FALSE(asks(0.00, 0));
  EXPECT_FALSE(asks(0.02, 0.2)) << "what a plan can follow";
  EXPECT_TRUE(asks(0.04, 1.2));
  EXPECT_FALSE(asks(0.06, 1.2)) << "once for each surprise";
  EXPECT_FALSE(asks(0.00, 0)) << "a new run begins";
}

struct Outcome {
  bool success;
  double time, first_touch, sustained;
  long fallbacks = 0, ticks = 0;
};

std::vector<Outcome> run(const std::string& scene, const std::string& name, int samples, const std::vector<std::string>& overrides = {}) {
  ControlTask task = tenon::make_task(scene, overrides);
  const auto controller = take_controller(task, name, newton_kkt);
  ClosedLoop loop(*task.plant, *controller, task.duration);
  std::vector<Outcome> outcomes;
  for (int seed = 1; seed <= samples; ++seed) {
    Outcome out{};
    loop.run(static_cast<std::uint64_t>(seed), [&](const Vector&) {
      ++out.ticks;
      out.fallbacks += controller->last_step().fell_back();
      return true;
    });
    Vector verdicts(task.plant->num_verdicts());
    task.plant->verdicts(verdicts);
    out.success = verdicts[3] == 1;
    out.time = verdicts[4], out.first_touch = verdicts[5], out.sustained = verdicts[6];
    outcomes.push_back(out);
  }
  return outcomes;
}

template <class Get>
double quantile(const std::vector<Outcome>& outcomes, double share, Get&& get) {
  std::vector<double> values;
  for (const Outcome& out : outcomes) values.push_back(get(out));
  std::ranges::sort(values);
  return values[std::min(values.size() - 1, static_cast<std::size_t>(share * static_cast<double>(values.size())))];
}

void expect_gentle(const std::vector<Outcome>& outcomes) {
  for (const Outcome& out : outcomes) EXPECT_TRUE(out.success);
  EXPECT_LE(quantile(outcomes, 0.95, [](const Outcome& o) { return o.time; }), 2);
  EXPECT_LE(quantile(outcomes, 0.95, [](const Outcome& o) { return o.sustained; }), 8);
  EXPECT_LE(quantile(outcomes, 0.95, [](const Outcome& o) { return o.first_touch; }), 15);
}

TEST(PegLoop, FindsTheHoleWithAndWithoutFriction) {
  for (const char* friction : {"friction=0", "friction=0.2"}) {
    SCOPED_TRACE(friction);
    expect_gentle(run("peg-in-hole", "mpc", 20, {friction}));
  }
}

TEST(PegLoop, FindsATightHoleOfUnknownHeight) {
  for (const char* friction : {"friction=0", "friction=0.2"}) {
    SCOPED_TRACE(friction);
    expect_gentle(run("peg-in-hole-tight", "mpc", 20, {friction}));
  }
}

TEST(PegLoop, WorksAtFiveHundredHertz) {
  expect_gentle(run("peg-in-hole", "mpc", 4, {"rate=500"}));
  expect_gentle(run("peg-in-hole-tight", "mpc", 4, {"rate=500"}));
}

TEST(PegLoop, SucceedsInAWorldThatIsNotAsBelieved) {
  for (const char* surprise : {"plant.clearance=1.2e-4", "plant.clearance=4e-4", "plant.delay=0.02", "friction=0.4"}) {
    for (const Outcome& out : run("peg-in-hole", "mpc", 5, {surprise})) {
      EXPECT_TRUE(out.success) << surprise;
      EXPECT_LE(out.time, 2.5) << surprise;
    }
  }
}

TEST(PegLoop, ADelayThatIsKnownCostsNoTime) {
  const auto slowest = [](const std::vector<std::string>& delays) {
    return quantile(run("peg-in-hole", "mpc", 10, delays), 1, [](const Outcome& out) { return out.time; });
  };
  const double none = slowest({}), known = slowest({"plant.delay=0.04", "horizon.delay=0.04"}), unknown = slowest({"plant.delay=0.04"});
  EXPECT_LE(known, none + 0.1);
  EXPECT_GE(unknown, none + 0.5);
}

TEST(PegLoop, TheTiltScriptNeverFailsAndSoftSpringsSeldom) {
  const std::vector<Outcome> tilt = run("peg-in-hole", "tilt", 40), soft = run("peg-in-hole", "soft", 40);
  EXPECT_TRUE(std::ranges::all_of(tilt, &Outcome::success));
  EXPECT_LE(quantile(tilt, 1, [](const Outcome& o) { return o.sustained; }), 7);
  EXPECT_GE(std::ranges::count_if(soft, &Outcome::success), 38);
}

/// What a controller was told and what it said.
struct Dialogue {
  std::vector<Vector> measurements, commands;
};

class Overheard final : public Controller {
 public:
  Overheard(Controller& inner, Dialogue& dialogue) : inner_(inner), dialogue_(dialogue) {}
  int num_measurements() const override { return inner_.num_measurements(); }
  int num_commands() const override { return inner_.num_commands(); }
  double period() const override { return inner_.period(); }
  void reset() override { inner_.reset(); }
  void update(double t, ConstVectorRef measurements, VectorRef commands) override {
    inner_.update(t, measurements, commands);
    dialogue_.measurements.push_back(measurements);
    dialogue_.commands.push_back(commands);
  }

 private:
  Controller& inner_;
  Dialogue& dialogue_;
};

// A controller made for a task with another true hole, told the same measurements: whatever is hidden cannot matter.
TEST(PegLoop, CommandsFollowFromMeasurementsAloneBitForBit) {
  ControlTask task = tenon::make_task("peg-in-hole");
  const auto controller = take_controller(task, "mpc", newton_kkt);
  Dialogue said;
  Overheard overheard(*controller, said);
  ClosedLoop(*task.plant, overheard, task.duration).run(5);

  ControlTask elsewhere = tenon::make_task("peg-in-hole", {"offset_x=-0.001", "offset_theta=0.02", "friction=0.4", "plant.clearance=3e-4", "plant.delay=0.01"});
  elsewhere.plant->reset(99);
  const auto other = take_controller(elsewhere, "mpc", newton_kkt);
  other->reset();
  Vector commands(kCommands);
  for (std::size_t k = 0; k < said.commands.size(); ++k) {
    other->update(static_cast<double>(k) * task.period, said.measurements[k], commands);
    ASSERT_EQ(commands, said.commands[k]) << "at tick " << k;
  }
}

TEST(PegLoop, ATickAllocatesNothing) {
  ControlTask task = tenon::make_task("peg-in-hole-tight");
  const auto controller = take_controller(task, "mpc", newton_kkt);
  controller->reset();
  task.plant->reset(3);
  Vector y(kMeasurements), commands(kCommands);
  long allocations = 0;
  for (int tick = 0; tick < 40; ++tick) {
    task.plant->measure(y);
    const AllocationCounter counter;
    controller->update(tick * task.period, y, commands);
    allocations += counter.count();
    task.plant->advance((tick + 1) * task.period, commands);
  }
  EXPECT_EQ(allocations, 0);
}

TEST(PegLoop, NoTickTakesManyIterationsTheFirstIncluded) {
  ControlTask task = tenon::make_task("peg-in-hole-tight");
  const auto controller = take_controller(task, "mpc", newton_kkt);
  ClosedLoop loop(*task.plant, *controller, task.duration);
  for (const std::uint64_t seed : {1u, 7u}) {  // both feel the flat first, and begin again from there
    std::vector<int> iterations;
    loop.run(seed, [&](const Vector&) {
      iterations.push_back(controller->last_step().iterations);
      return true;
    });
    EXPECT_EQ(iterations.front(), 1) << "goes on from the plan made ahead";
    EXPECT_EQ(*std::max_element(iterations.begin(), iterations.end()), 6);
  }
}

TEST(PegTask, SaysWhatIsWrongInItsFile) {
  EXPECT_MESSAGE(tenon::make_task("peg-in-hole", {"clearance=-1e-4"}), InputError, "clearance is -0.0001 (expected more than 0)");
  EXPECT_MESSAGE(tenon::make_task("peg-in-hole", {"frictoin=0.1"}), InputError, "friction");
  EXPECT_MESSAGE(tenon::make_task("peg-in-hole", {"plant.mass=[1, 0, 1]"}), InputError, "a mass is not positive");
}

TEST(PegTask, ACommandActsAfterTheDelayOfThePlant) {
  const ControlTask task = tenon::make_task("peg-in-hole", {"plant.delay=0.03"});
  task.plant->reset(0);
  Vector y(kMeasurements), commands = Vector::Zero(kCommands);
  commands.segment<3>(kReference) << 0, 0.004, 0;
  commands.segment<3>(kStiffness) << 1000, 1000, 3;
  for (int tick = 0; tick < 3; ++tick) {
    task.plant->measure(y);
    EXPECT_NEAR(y[kMeasuredReference + 1], tick < 2 ? 0.005 : 0.004, 1e-12) << "at tick " << tick;
    task.plant->advance((tick + 1) * task.period, commands);
  }
}

TEST(PegTask, AWorldOfSeedZeroIsTheOneInTheFile) {
  ControlTask task = tenon::make_task("peg-in-hole", {"offset_x=0.0004"});
  task.plant->reset(0);
  Vector verdicts(task.plant->num_verdicts()), y(kMeasurements);
  task.plant->verdicts(verdicts);
  EXPECT_EQ(verdicts[0], 0.0004);
  EXPECT_EQ(verdicts[2], 0);
  task.plant->measure(y);
  EXPECT_EQ(y[kMeasuredForce], 0) << "no noise either";
}

}  // namespace
}  // namespace tenon::peg
