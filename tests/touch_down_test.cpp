// The touch-down: soft in every world, force only where there is contact, and what the sources' pair does instead.
#include <gtest/gtest.h>

#include <cstring>
#include <map>

#include "tenon/mpc/closed_loop.hpp"
#include "tenon/mpc/receding_horizon.hpp"
#include "tenon/mpc/task_controllers.hpp"
#include "tenon/problems/tasks.hpp"
#include "tenon/problems/touch_down/horizon.hpp"
#include "tenon/problems/touch_down/plane_estimator.hpp"
#include "tenon/solvers/make_solver.hpp"
#include "tenon/tests/allocation_counter.hpp"

namespace tenon::touch_down {
namespace {

std::unique_ptr<Solver> newton(const Nlp& problem, const Options& options) { return make_solver("newton-kkt", problem, options); }

std::map<std::string, double> run(ControlTask& task, Controller& controller, std::uint64_t seed) {
  ClosedLoop(*task.plant, controller, task.duration).run(seed);
  Vector values(task.plant->num_verdicts());
  task.plant->verdicts(values);
  std::map<std::string, double> verdicts;
  for (int i = 0; i < values.size(); ++i) verdicts[task.plant->verdict_name(i)] = values[i];
  return verdicts;
}

TEST(TouchDown, IsSoftAndHoldsItsForceInAllOf200Worlds) {
  ControlTask task = make_task("delta-touch-down");
  const auto controller = take_controller(task, "mpc", &newton);
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    auto verdicts = run(task, *controller, seed);
    EXPECT_LT(verdicts["touch_speed"], 0.015) << "world " << seed;
    EXPECT_LT(verdicts["peak_force"], 8) << "world " << seed;
    EXPECT_LT(verdicts["rebound"], 5e-5) << "world " << seed;
    EXPECT_NEAR(verdicts["held_force"], 5, 0.1) << "world " << seed;
    EXPECT_LE(verdicts["held_since"], 1.3) << "world " << seed;
    EXPECT_EQ(verdicts["success"], 1) << "world " << seed;
  }
}

TEST(TouchDown, TheBaselinesDoNotDoThat) {
  ControlTask task = make_task("delta-touch-down");
  const auto tracking = take_controller(task, "tracking", &newton), pair = take_controller(task, "pair", &newton);
  int tracked = 0, paired = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    tracked += run(task, *tracking, seed)["success"] == 1;
    paired += run(task, *pair, seed)["success"] == 1;
  }
  EXPECT_EQ(tracked, 0) << "a plane 1 mm off is met at speed";
  EXPECT_EQ(paired, 0) << "a plan that presses at a distance does not press where the plane is";
}

/// The largest lambda h (N m) of a plan at either end of an interval.
double force_at_a_distance(const Horizon& horizon, const Vector& x, double plane) {
  double largest = 0;
  for (int k = 0; k + 5 < horizon.num_variables(); k += 5) {
    for (const int end : {k, k + 5}) largest = std::max(largest, x[k + 4] * (plane - x[end] / 100));
  }
  return largest;
}

TEST(TouchDown, APlanPressesOnlyWhereThereIsContactWhileThePairPressesAtADistance) {
  constexpr double kStart = 0.36, kPlane = 0.42;
  double product[2];
  for (const bool pair : {false, true}) {
    Parameters parameters;
    if (pair) parameters.contact = Parameters::Contact::pair;
    Horizon horizon(parameters, kStart, kPlane);
    Vector measured(5), wanted(2);
    measured << kStart, 0, 0, 0, 0;
    wanted << kPlane, 0;  // as long as nothing was felt
    horizon.observe(0, measured, wanted);
    Point plan(horizon.num_variables(), horizon.num_constraints());
    horizon.initial_point(plan.x);
    const Result result = make_solver("newton-kkt", horizon)->solve(plan);
    EXPECT_LE(result.residual.primal, 1e-6);
    product[pair] = force_at_a_distance(horizon, plan.x, kPlane);
  }
  EXPECT_LE(product[0], 1.01 * Parameters().slack);
  EXPECT_GT(product[1], 10 * Parameters().slack);
}

TEST(TouchDown, ThePlaneIsTheNearestPlausibleOneUntilItIsFelt) {
  PlaneEstimator estimator{PlaneKnowledge{}};
  Vector measured(5), mean(2), commands = Vector::Zero(1);
  const auto update = [&](double z, double force, double peak) {
    measured << z, 0, force, peak, 0;
    estimator.update(0, measured, commands);
    estimator.mean(mean);
  };
  update(0.40, 0, 0);
  EXPECT_DOUBLE_EQ(mean[0], 0.418);
  EXPECT_EQ(mean[1], 0);
  update(0.419, 0, 0);
  EXPECT_DOUBLE_EQ(mean[0], 0.4195);  // not there yet: it lies ahead
  update(0.4193, 0, 0.9);             // a tap within the tick, gone at its end
  EXPECT_EQ(mean[1], 5);
  update(0.4194, 4, 4);
  EXPECT_DOUBLE_EQ(mean[0], 0.4194);
  update(0.4190, 0, 0);
  EXPECT_EQ(mean[1], 5) << "once felt, always felt";
  Eigen::MatrixXd covariance(2, 2);
  estimator.covariance(covariance);
  EXPECT_LT(covariance(0, 0), 1e-8);
  estimator.reset();
  estimator.covariance(covariance);
  EXPECT_NEAR(covariance(0, 0), 4e-3 * 4e-3 / 12, 1e-12);
}

TEST(TouchDown, ATickAllocatesNothingAndRepeatsBitForBit) {
  ControlTask task = make_task("delta-touch-down");
  const auto controller = take_controller(task, "mpc", &newton);
  std::vector<double> first, second;
  for (std::vector<double>* commands : {&first, &second}) {
    Vector measured(5), w(1);
    task.plant->reset(7);
    controller->reset();
    commands->reserve(200);
    for (int k = 0; k < 200; ++k) {
      task.plant->measure(measured);
      const AllocationCounter counter;
      controller->update(0.01 * k, measured, w);
      EXPECT_EQ(counter.count(), 0) << "tick " << k;
      commands->push_back(w[0]);
      task.plant->advance(0.01 * (k + 1), w);
    }
  }
  EXPECT_EQ(std::memcmp(first.data(), second.data(), first.size() * sizeof(double)), 0);
}

}  // namespace
}  // namespace tenon::touch_down
