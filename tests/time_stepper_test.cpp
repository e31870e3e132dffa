// What the sources say of fixed steps, shown: a time-stepper's energy and peak force are matters of its step, those of the hybrid DAE are
// not. The table stands in problems/contact/contact.md.
#include <gtest/gtest.h>

#include <numbers>

#include "tenon/tests/lcp_time_stepper.hpp"
#include "tenon/tests/scene_run.hpp"

namespace tenon {
namespace {

contact::Scene<2> planar(const std::string& name) {
  return std::get<contact::Scene<2>>(contact::load_scene(name).scene);
}

const double kSwing = 9.81 * (1 - std::cos(std::numbers::pi / 6));  // J
const std::vector<double> kSteps{1e-2, 1e-3, 1e-4};                 // s
const std::vector<double> kTolerances{1e-6, 1e-8, 1e-10};

TEST(TimeStepper, ACradlesEnergyIsAMatterOfItsStepAndItsOutcomeWrongAtEach) {
  const contact::ContactDae<2> dae(planar("cradle"));
  const double arrival = std::sqrt(2 * kSwing);  // of 1 kg, m/s
  std::vector<double> errors;
  for (const double dt : kSteps) {
    LcpTimeStepper stepper(dae);
    const double start = stepper.energy();
    while (stepper.state().t < 0.511) stepper.step(dt);
    const double last = stepper.state().x.segment<2>(4 * 4 + 2).norm();
    EXPECT_LT(last, 0.5 * arrival) << "touching balls leave together, step " << dt;
    while (stepper.state().t < 10.2) stepper.step(dt);
    errors.push_back(std::abs(stepper.energy() - start) / kSwing);
    EXPECT_GT(errors.back(), 1e-4) << dt;
  }
  EXPECT_GT(errors[2], errors[1]) << "a smaller step does not help";
  for (const double rtol : kTolerances) {
    const SceneRun run = run_scene("cradle", {}, "dop853", rtol);
    EXPECT_LT(run.largest("energy_error"), 1e-8 * kSwing) << rtol;
    EXPECT_EQ(run.events_to(1).front().contact, "touch1");
    EXPECT_NEAR(-run.events_to(1)[3].gap_rate_before, arrival, 1e-5) << "the last of the first four pairs passes all of it on";
  }
}

TEST(TimeStepper, ABoxInACornerMeetsAForceThatIsTheStepsAlone) {
  contact::Scene<2> scene = planar("box-in-corner");
  for (auto& c : scene.constraints) c.restitution = 0;
  const contact::ContactDae<2> dae(scene);
  const auto wall = [&](const Vector& forces) {
    double sum = 0;
    for (int i = 0; i < forces.size(); ++i) sum += dae.algebraic_name(i).starts_with("lambda_wall") ? forces[i] : 0;
    return sum;
  };
  std::vector<double> peaks;
  for (const double dt : kSteps) {
    LcpTimeStepper stepper(dae);
    double peak = 0;
    while (stepper.state().t < 0.5) stepper.step(dt), peak = std::max(peak, wall(stepper.forces()));
    peaks.push_back(peak);
  }
  EXPECT_GT(peaks[1], 5 * peaks[0]) << "m v / dt";
  EXPECT_GT(peaks[2], 5 * peaks[1]);
  for (const double rtol : kTolerances) {
    const SceneRun run = run_scene("box-in-corner", {"simulation.output_step=1e-4"}, "dop853", rtol);
    double peak = 0;
    for (const DaeState& state : run.states) peak = std::max(peak, wall(state.y));
    EXPECT_NEAR(peak, 161.421, rtol < 1e-7 ? 1e-3 : 0.04) << rtol << ", N: alpha1 m v + 20";
  }
}

}  // namespace
}  // namespace tenon
