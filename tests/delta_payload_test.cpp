// What the delta carries, from its motors' angles and torques: in every world, as surely as is said, and no more than the motion tells.
#include <gtest/gtest.h>

#include "tenon/core/check_derivatives.hpp"
#include "tenon/core/input_error.hpp"
#include "tenon/mpc/estimation_window.hpp"
#include "tenon/problems/delta/robot_file.hpp"
#include "tenon/problems/delta_payload/model.hpp"
#include "tenon/tests/estimation_run.hpp"
#include "tenon/tests/expect_message.hpp"

namespace tenon::delta_payload {
namespace {

constexpr int kWorlds = 24;

TEST(DeltaPayload, ACircleTellsPayloadAndDamping) {
  EstimationRun experiment("delta-payload", {"duration=1.5"});
  double sum = 0;
  for (std::uint64_t seed = 1; seed <= kWorlds; ++seed) {
    experiment.run(seed);
    sum += experiment.normalised_error();
    EXPECT_LT(experiment.deviation(kPayload), 7e-4) << "world " << seed << ": 0.05 before";
    for (const int i : {kPayload, kDamping}) {
      EXPECT_NEAR(experiment.mean[i], experiment.truth[i], 4 * experiment.deviation(i))
          << "world " << seed << ": " << kStateNames[std::size_t(i)];
    }
  }
  EXPECT_NEAR(sum / kWorlds, kStates, consistency_bound(kStates, kWorlds));
  EXPECT_EQ(experiment.allocations, 0);
}

TEST(DeltaPayload, AtRestThePayloadIsSeenAndTheMotorsFrictionIsNot) {
  EstimationRun experiment("delta-payload", {"motion=\"hold\"", "duration=1"});
  experiment.run(0);  // without noise: nothing moves
  EXPECT_NEAR(experiment.mean[kPayload], 0.14, 1e-3);
  EXPECT_LT(experiment.deviation(kPayload), 1e-3);
  EXPECT_GT(experiment.deviation(kDamping) / experiment.mean[kDamping], 0.9 * 0.4) << "0.4 before";
}

TEST(DeltaPayload, ItsDerivativesAreThoseOfItsWindow) {
  Parameters parameters;
  parameters.robot = delta::load_robot("delta");
  const Prior known = prior(parameters, {0.1, 0.05}, {0.01, 0.004});
  const EstimationProblem problem = estimation_problem(parameters, known, 2);
  EstimationWindow window(problem);
  Vector x(window.num_variables()), y = Vector::Constant(3, 0.1), torque = Vector::Constant(3, -0.5);
  window.initial_point(x);
  for (int k = 0; k < 3; ++k) window.slide(x, 0.01, torque, y);
  window.initial_point(x);
  x.array() += 0.3;
  const DerivativeReport report = check_derivatives(window, x, 1, Vector::Zero(window.num_constraints()), 1e-5);
  EXPECT_TRUE(report.passed(1e-5)) << report.jacobian_error;
}

TEST(DeltaPayload, RefusesAFileThatMakesNoSense) {
  const auto make = [](const std::string& change) { make_task("delta-payload", {change}); };
  EXPECT_MESSAGE(make("motion=\"swing\""), InputError, "unknown motion 'swing' (expected circle or hold)");
  EXPECT_MESSAGE(make("centre=[0, 0, 2]"), InputError, "robot delta does not reach the centre");
  EXPECT_MESSAGE(make("believed.payload=[0, 0.05]"), InputError, "a median or a deviation that is not positive");
  EXPECT_MESSAGE(make("robot=\"gamma\""), InputError, "gamma");
}

}  // namespace
}  // namespace tenon::delta_payload
