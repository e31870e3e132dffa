// The pushed block: what a finger's place and force tell of a body that nobody measures, and what they do not.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tenon/core/input_error.hpp"
#include "tenon/mpc/closed_loop.hpp"
#include "tenon/mpc/task_controllers.hpp"
#include "tenon/problems/pushed_block/model.hpp"
#include "tenon/problems/tasks.hpp"
#include "tenon/solvers/make_solver.hpp"
#include "tenon/tests/allocation_counter.hpp"
#include "tenon/tests/expect_message.hpp"

namespace tenon::pushed_block {
namespace {

std::unique_ptr<Solver> newton(const Nlp& problem, const Options& options) { return make_solver("newton-kkt", problem, options); }

/// An experiment and what its estimator makes of it, in one world after another.
class Experiment {
 public:
  explicit Experiment(const std::vector<std::string>& overrides = {})
      : task_(make_task("pushed-block", overrides)),
        estimator_(take_estimator(task_, &newton)),
        script_(take_controller(task_, "script", &newton)),
        loop_(*task_.plant, *script_, task_.duration) {}

  void run(std::uint64_t seed) {
    const std::vector<std::string> columns = loop_.columns();
    const auto column = [&](const std::string& name) { return std::ranges::find(columns, name) - columns.begin(); };
    const auto measured = column("measured_finger"), force = column("force");
    estimator_->reset();
    Vector held = Vector::Zero(1), y(1);
    loop_.run(seed, [&](const Vector& row) {
      y[0] = row[measured];
      const AllocationCounter counter;
      estimator_->update(row[0], y, held);
      allocations += counter.count();
      held[0] = row[force];
      truth = row.segment(1, kStates);
      return true;
    });
    estimator_->mean(mean);
    estimator_->covariance(covariance);
  }

  State truth, mean;
  Eigen::Matrix<double, kStates, kStates> covariance;
  long allocations = 0;

  double deviation(int i) const { return std::sqrt(covariance(i, i)); }
  /// Mass and friction by their logarithms.
  State error() const {
    State e = truth - mean;
    for (const int i : {kBlockMass, kFriction}) e[i] = mean[i] * std::log(truth[i] / mean[i]);
    return e;
  }
  double normalised_error() const {
    const Eigen::Matrix<double, kStates, kStates> whole = covariance.selfadjointView<Eigen::Lower>();
    return error().dot(whole.llt().solve(error()));
  }

 private:
  ControlTask task_;
  std::unique_ptr<Estimator> estimator_;
  std::unique_ptr<Controller> script_;
  ClosedLoop loop_;
};

constexpr int kWorlds = 60;

// A mean of chi squared with n degrees of freedom over the worlds has the deviation sqrt(2 n / worlds).
void expect_consistent(double sum, int freedom) { EXPECT_NEAR(sum / kWorlds, freedom, 3 * std::sqrt(2.0 * freedom / kWorlds)); }

TEST(PushedBlock, AShakenFingerTellsPlaceMassAndFrictionOfWhatItPushes) {
  Experiment experiment;
  double sum = 0;
  for (std::uint64_t seed = 1; seed <= kWorlds; ++seed) {
    experiment.run(seed);
    sum += experiment.normalised_error();
    EXPECT_NEAR(experiment.mean[kBlock], experiment.truth[kBlock], 3e-4) << "world " << seed;
    EXPECT_NEAR(experiment.mean[kBlockRate], experiment.truth[kBlockRate], 1e-2) << "world " << seed;
    EXPECT_NEAR(experiment.mean[kBlockMass], experiment.truth[kBlockMass], 0.06 * experiment.truth[kBlockMass]) << "world " << seed;
    EXPECT_NEAR(experiment.mean[kFriction], experiment.truth[kFriction], 0.06 * experiment.truth[kFriction]) << "world " << seed;
    EXPECT_LT(experiment.deviation(kBlockMass), 0.01) << "world " << seed << ": 0.06 before";
  }
  expect_consistent(sum, kStates);
  EXPECT_EQ(experiment.allocations, 0);
}

TEST(PushedBlock, AtASteadySpeedMassAndFrictionAreKnownTogetherNotApart) {
  Experiment experiment({"motion=steady"});
  double sum = 0;
  for (std::uint64_t seed = 1; seed <= kWorlds; ++seed) {
    experiment.run(seed);
    sum += experiment.normalised_error();
    const auto& p = experiment.covariance;
    EXPECT_LT(p(kFriction, kBlockMass) / (experiment.deviation(kBlockMass) * experiment.deviation(kFriction)), -0.98) << "world " << seed;
    EXPECT_GT(experiment.deviation(kBlockMass), 0.01) << "world " << seed;
    // mu m g tanh(v/v_s) is what the finger carries
    const double carried = experiment.truth[kBlockMass] * experiment.truth[kFriction];
    EXPECT_NEAR(experiment.mean[kBlockMass] * experiment.mean[kFriction], carried, 0.03 * carried) << "world " << seed;
  }
  expect_consistent(sum, kStates);
}

TEST(PushedBlock, AFingerThatTouchesNothingLearnsNothingOfTheBlock) {
  Experiment experiment({"motion=rest"});
  experiment.run(3);
  for (const auto& [i, mean, deviation] : {std::tuple{kBlock, 0.03, 0.004}, {kBlockMass, 0.3, 0.06}, {kFriction, 0.3, 0.06}}) {
    EXPECT_NEAR(experiment.mean[i], mean, 1e-4 * deviation) << kStateNames[i];
    EXPECT_NEAR(experiment.deviation(i), deviation, 1e-2 * deviation) << kStateNames[i];
  }
}

TEST(PushedBlock, IsTheSameBitForBitEveryTime) {
  Experiment one, two;
  two.run(8);
  one.run(7), two.run(7);
  EXPECT_EQ(one.mean, two.mean);
  EXPECT_EQ(one.covariance, two.covariance);
  EXPECT_EQ(one.truth, two.truth);
}

TEST(PushedBlock, RefusesAFileThatMakesNoSense) {
  const auto make = [](const std::string& change) { make_task("pushed-block", {change}); };
  EXPECT_MESSAGE(make("motion=\"idle\""), InputError, "unknown motion 'idle' (expected rest, steady or shaken)");
  EXPECT_MESSAGE(make("believed.mass=[0.3, 0]"), InputError, "a mean or a deviation that is not positive (expected [mean, deviation]");
  EXPECT_MESSAGE(make("window=0"), InputError, "window");
  EXPECT_MESSAGE(make("block.mass=-1"), InputError, "mass");
}

}  // namespace
}  // namespace tenon::pushed_block
