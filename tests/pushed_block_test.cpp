// The pushed block: what a finger's place and force tell of a body that nobody measures, and what they do not.
#include <gtest/gtest.h>

#include "tenon/core/input_error.hpp"
#include "tenon/problems/pushed_block/model.hpp"
#include "tenon/tests/estimation_run.hpp"
#include "tenon/tests/expect_message.hpp"

namespace tenon::pushed_block {
namespace {

constexpr int kWorlds = 50;

TEST(PushedBlock, AShakenFingerTellsPlaceMassAndFrictionOfWhatItPushes) {
  EstimationRun experiment("pushed-block", {});
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
  EXPECT_NEAR(sum / kWorlds, kStates, consistency_bound(kStates, kWorlds));
  EXPECT_EQ(experiment.allocations, 0);
}

TEST(PushedBlock, AtASteadySpeedMassAndFrictionAreKnownTogetherNotApart) {
  EstimationRun experiment("pushed-block", {"motion=steady"});
  double sum = 0;
  for (std::uint64_t seed = 1; seed <= kWorlds; ++seed) {
    experiment.run(seed);
    sum += experiment.normalised_error();
    EXPECT_LT(experiment.correlation(kFriction, kBlockMass), -0.98) << "world " << seed;
    EXPECT_GT(experiment.deviation(kBlockMass), 0.01) << "world " << seed;
    // mu m g tanh(v/v_s) is what the finger carries
    const double carried = experiment.truth[kBlockMass] * experiment.truth[kFriction];
    EXPECT_NEAR(experiment.mean[kBlockMass] * experiment.mean[kFriction], carried, 0.03 * carried) << "world " << seed;
  }
  EXPECT_NEAR(sum / kWorlds, kStates, consistency_bound(kStates, kWorlds));
}

TEST(PushedBlock, AFingerThatTouchesNothingLearnsNothingOfTheBlock) {
  EstimationRun experiment("pushed-block", {"motion=rest"});
  experiment.run(3);
  for (const auto& [i, mean, deviation] : {std::tuple{kBlock, 0.03, 0.004}, {kBlockMass, 0.3, 0.06}, {kFriction, 0.3, 0.06}}) {
    EXPECT_NEAR(experiment.mean[i], mean, 1e-4 * deviation) << kStateNames[i];
    EXPECT_NEAR(experiment.deviation(i), deviation, 1e-2 * deviation) << kStateNames[i];
  }
}

TEST(PushedBlock, IsTheSameBitForBitEveryTime) {
  EstimationRun one("pushed-block", {}), two("pushed-block", {});
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
