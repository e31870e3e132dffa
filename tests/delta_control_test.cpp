// The delta robot's control law and controller: what each promises, on many robots, without a simulator.
#include <gtest/gtest.h>

#include "tenon/problems/delta/controller.hpp"
#include "tenon/problems/delta/wrist_gimbals.hpp"
#include "tenon/tests/allocation_counter.hpp"
#include "tenon/tests/delta_robots.hpp"
#include "tenon/tests/expect_message.hpp"

namespace tenon::delta {
namespace {

Vector3 motors_of(const Vector9& q) {
  return {q[0], q[3], q[6]};
}

/// A controller at rest on `wrist`, measuring rates.
struct Bench {
  Robot robot = load_robot("delta");
  ControllerOptions options;
  Measurement at(const Vector3& wrist) const {
    Measurement m;
    m.angle = motors_of(inverse_kinematics(robot, wrist).q);
    return m;
  }
};

TEST(DeltaLaw, TheGainsOfPolesAtSevenAreThePublishedOnes) {
  EXPECT_EQ(kDefaultGains.proportional, 147);
  EXPECT_EQ(kDefaultGains.derivative, 21);
  EXPECT_EQ(kDefaultGains.integral, 343);
}

TEST(DeltaLaw, FeedbackLinearisationGivesTheWristTheAccelerationAskedFor) {
  std::mt19937_64 random(2);
  for (int n = 0; n < 12; ++n) {
    const Robot robot = test_robot(n, random);
    for (int pose = 0; pose < 10; ++pose) {
      const Vector9 q = random_configuration(robot, random);
      const Configuration at(q);
      const Vector9 v = Motion(robot, at).rates(random_vector(random, 2));
      const Sensed sensed(robot, at, v);
      ASSERT_TRUE(sensed.ok);
      LawOptions options;
      options.gains = pose % 2 == 0 ? kDefaultGains : kLowGains;
      const Law law(robot, options);
      const Reference reference{sensed.wrist + random_vector(random, 0.02), random_vector(random, 0.3), random_vector(random, 1)};
      const Vector3 integral = random_vector(random, 1e-3);
      const Gains& k = options.gains;
      const Vector3 w = reference.acceleration + k.derivative * (reference.velocity - sensed.velocity) +
                        k.proportional * (reference.position - sensed.wrist) + k.integral * integral;
      const Vector3 torque = law.torque(sensed, reference, integral).torque;
      const Acceleration a = acceleration(robot, law.constants(), at, v, torque, Vector3::Zero());
      Vector3 bias = Vector3::Zero();
      for (int i = 0; i < kArms; ++i) bias += to_world(i, at[i].bias(robot, v.segment<3>(3 * i))) / 3;
      EXPECT_LE((simulation_jacobian(robot, at) * a.v_rate + bias - w).norm(), 1e-9 * (1 + w.norm())) << robot.name << " " << n;
    }
  }
}

TEST(DeltaLaw, AMeasurementOfTheMotorsIsAsGoodAsAllNineAngles) {
  std::mt19937_64 random(4);
  const Robot robot = load_robot("delta");
  for (int pose = 0; pose < 20; ++pose) {
    const Vector9 q = random_configuration(robot, random);
    const Vector3 rate = random_vector(random, 1);
    const Sensed all(robot, Configuration(q), Motion(robot, Configuration(q)).rates(rate)), motors(robot, motors_of(q), rate);
    const Reference reference{all.wrist + random_vector(random, 0.01), random_vector(random, 0.1), random_vector(random, 0.1)};
    for (const LawForm form : {LawForm::linearising, LawForm::impedance}) {
      LawOptions options;
      options.form = form;
      const Law law(robot, options);
      EXPECT_LE((law.torque(all, reference, {0, 0, 0}).torque - law.torque(motors, reference, {0, 0, 0}).torque).norm(), 1e-11);
    }
  }
}

TEST(DeltaLaw, UnderImpedanceAForceMovesTheWristByForceOverStiffness) {
  Bench bench;
  LawOptions options;
  options.form = LawForm::impedance;
  options.stiffness = {100, 200, 400};
  const Law law(bench.robot, options);
  const Vector3 wrist(0.02, -0.03, 0.4), force(1, -2, 3);
  const Reference reference{wrist - force.cwiseQuotient(options.stiffness), {0, 0, 0}, {0, 0, 0}};
  const Configuration at(inverse_kinematics(bench.robot, wrist).q);
  const Sensed sensed(bench.robot, at, Vector9::Zero());
  const Acceleration a =
      acceleration(bench.robot, law.constants(), at, Vector9::Zero(), law.torque(sensed, reference, {0, 0, 0}).torque, force);
  EXPECT_LE(a.v_rate.norm(), 1e-9);
}

TEST(DeltaController, HoldsTheWeightAtItsReference) {
  Bench bench;
  Controller controller(bench.robot, bench.options);
  const Vector3 wrist(0.05, 0.02, 0.42);
  controller.set_reference({wrist, {0, 0, 0}, {0, 0, 0}});
  const Command& command = controller.tick(bench.at(wrist));
  const Configuration at(inverse_kinematics(bench.robot, wrist).q);
  EXPECT_LE((command.torque - gravity_torque(ArmConstants(bench.robot), at, Motion(bench.robot, at))).norm(), 1e-10);
  EXPECT_FALSE(command.saturated || command.singular);
  EXPECT_LE(command.error.norm(), 1e-14);
}

TEST(DeltaController, TheIntegralStaysWithinItsLimitAndComesBackAtOnce) {
  Bench bench;
  Controller controller(bench.robot, bench.options);
  const Vector3 wrist(0, 0, 0.4);
  controller.set_reference({wrist + Vector3(0.005, 0, 0), {0, 0, 0}, {0, 0, 0}});
  for (int k = 0; k < 5000; ++k) controller.tick(bench.at(wrist));
  EXPECT_NEAR(343 * controller.state().integral[0], 1, 1e-12);
  EXPECT_NEAR(controller.state().integral[1], 0, 1e-12);
  controller.set_reference({wrist - Vector3(0.005, 0, 0), {0, 0, 0}, {0, 0, 0}});
  controller.tick(bench.at(wrist));
  EXPECT_LT(343 * controller.state().integral[0], 1);
}

TEST(DeltaController, ASaturatedMotorIsReportedAndStopsTheIntegral) {
  Bench bench;
  bench.robot.torque_limit = 0.5;
  Controller controller(bench.robot, bench.options);
  controller.set_reference({{0.2, 0, 0.4}, {0, 0, 0}, {0, 0, 0}});
  const Command& command = controller.tick(bench.at({0, 0, 0.4}));
  EXPECT_TRUE(command.saturated);
  EXPECT_EQ(command.torque.cwiseAbs().maxCoeff(), 0.5);
  EXPECT_EQ(controller.state().integral, Vector3(0, 0, 0));
}

TEST(DeltaController, AtASingularityItHoldsTheTorqueThatLastHeldTheWeight) {
  Bench bench;
  Controller controller(bench.robot, bench.options);
  controller.set_reference({{0, 0, 0.4}, {0, 0, 0}, {0, 0, 0}});
  const Vector3 before = controller.tick(bench.at({0, 0, 0.4})).torque;
  const Command& command = controller.tick(bench.at({0, 0, 0.6480740698}));
  EXPECT_TRUE(command.singular);
  EXPECT_LE((command.torque - before).norm(), 1e-12);
  Measurement broken;
  broken.angle.setConstant(std::nan(""));
  EXPECT_TRUE(controller.tick(broken).singular);
  EXPECT_TRUE(controller.tick(broken).torque.allFinite());
}

TEST(DeltaController, TheTactileLoopMovesTheReferenceTowardTheSofterSide) {
  Bench bench;
  bench.options.tactile_gain = 0.5;
  bench.options.tactile_limit = 0.001;
  Controller controller(bench.robot, bench.options);
  controller.set_reference({{0, 0, 0.4}, {0, 0, 0}, {0, 0, 0}});
  Measurement m = bench.at({0, 0, 0.4});
  m.tactile_left = 1.5, m.tactile_right = 0.5;
  controller.tick(m);
  EXPECT_NEAR(controller.reference().position[0], 0.5 * 1 * 1e-3, 1e-15);
  for (int k = 0; k < 100; ++k) controller.tick(m);
  EXPECT_EQ(controller.reference().position[0], 0.001);
}

TEST(DeltaController, RatesFromFilteredDifferencesAreTheRates) {
  Bench bench;
  bench.options.period = 1e-4;
  Controller measured(bench.robot, bench.options);
  bench.options.filter_frequency = 500;
  Controller filtered(bench.robot, bench.options);
  Measurement m = bench.at({0, 0, 0.4});
  m.rate = {0.3, -0.2, 0.1};
  Vector3 a, b;
  for (int k = 0; k < 200; ++k) {
    m.angle += 1e-4 * m.rate;
    for (Controller* c : {&measured, &filtered}) c->set_reference({{0, 0, 0.4}, {0, 0, 0}, {0, 0, 0}});
    a = measured.tick(m).torque;
    b = filtered.tick(m).torque;
  }
  EXPECT_LE((a - b).norm(), 1e-6);
}

TEST(DeltaController, TheFilterPassesSlowSignalsAndHalvesThePowerAtItsFrequency) {
  const LowPass filter(50, 1e-3);
  for (const auto& [frequency, gain, tolerance] : {std::tuple{1.0, 1.0, 1e-3}, {50.0, std::sqrt(0.5), 1e-3}, {400.0, 0.0, 0.02}}) {
    LowPass::State state;
    double largest = 0;
    for (int k = 0; k < 4000; ++k) {
      const double out = filter(Vector3::Constant(std::sin(2 * M_PI * frequency * 1e-3 * k + 0.3)), state)[1];
      if (k > 2000) largest = std::max(largest, std::abs(out));
    }
    EXPECT_NEAR(largest, gain, tolerance) << frequency;
  }
}

TEST(DeltaController, ATickAllocatesNothingAndDependsOnItsStateAlone) {
  Bench bench;
  bench.options.filter_frequency = 200;
  bench.options.tactile_gain = 0.1;
  Controller controller(bench.robot, bench.options);
  controller.set_reference({{0.01, 0, 0.41}, {0, 0, 0}, {0, 0, 0}});
  Measurement m = bench.at({0, 0, 0.4});
  m.tactile_left = 1;
  controller.tick(m);
  Vector numbers(ControllerState::kSize);
  controller.state().write(numbers);
  AllocationCounter counter;
  for (int k = 0; k < 100; ++k) controller.tick(m);
  EXPECT_EQ(counter.count(), 0);
  const Vector3 after = controller.tick(m).torque;
  Controller other(bench.robot, bench.options);
  other.reset(ControllerState::read(numbers));
  other.set_reference({{0.01, 0, 0.41}, {0, 0, 0}, {0, 0, 0}});
  for (int k = 0; k < 100; ++k) other.tick(m);
  EXPECT_EQ(other.tick(m).torque, after);
}

TEST(DeltaController, RefusesWhatMakesNoSense) {
  const Robot robot = load_robot("delta");
  const auto with = [](auto change) {
    ControllerOptions options;
    change(options);
    return options;
  };
  EXPECT_MESSAGE(Controller(robot, with([](auto& o) { o.period = 0; })), std::invalid_argument, "period is 0");
  EXPECT_MESSAGE(Controller(robot, with([](auto& o) { o.filter_frequency = 500; })), std::invalid_argument, "filter_frequency is 500");
  EXPECT_MESSAGE(Controller(robot, with([](auto& o) { o.tactile_axis = {1, 1, 0}; })), std::invalid_argument, "tactile_axis");
  EXPECT_MESSAGE(Controller(robot, with([](auto& o) { o.integral_limit = -1; })), std::invalid_argument, "integral_limit");
}

TEST(WristGimbals, CoriolisTorquesTakeTheWorkOfTheChangingInertia) {
  const WristGimbals gimbals{{1e-4, 2e-4, 3e-4}};
  const Vector3 angle(0.3, 0.7, -0.4), rate(1, -2, 3);
  constexpr double kStep = 1e-6;
  Vector3 c = (gimbals.mass(angle + kStep * rate) - gimbals.mass(angle - kStep * rate)) * rate / (2 * kStep);
  for (int j = 0; j < 3; ++j) {
    const Vector3 step = kStep * Vector3::Unit(j);
    c[j] -= rate.dot((gimbals.mass(angle + step) - gimbals.mass(angle - step)) * rate) / (4 * kStep);
  }
  EXPECT_LE((gimbals.coriolis(angle, rate) - c).norm(), 1e-12);
  const Vector3 w(5, 6, 7);
  EXPECT_LE((gimbals.acceleration(angle, rate, gimbals.linearising_torque(angle, rate, w)) - w).norm(), 1e-12);
  EXPECT_NEAR(GimbalFrame(angle).attitude.determinant(), 1, 1e-15);
}

TEST(WristGimbals, TheEnergyIsThatOfTheThreeBodies) {
  // yaw ring: a'^2; pitch ring: |a' z + b' y|^2; tool: |angular velocity|^2, each times half its inertia
  const WristGimbals gimbals{{1e-4, 2e-4, 3e-4}};
  const Vector3 angle(0.3, 0.7, -0.4), rate(1, -2, 3);
  constexpr double kStep = 1e-6;
  const Matrix3 spin = (GimbalFrame(angle + kStep * rate).attitude - GimbalFrame(angle - kStep * rate).attitude) / (2 * kStep) *
                       GimbalFrame(angle).attitude.transpose();
  const Vector3 turning(spin(2, 1), spin(0, 2), spin(1, 0));
  EXPECT_LE((GimbalFrame(angle).axes * rate - turning).norm(), 1e-8);
  const double tool = turning.squaredNorm();
  const double expected = (1e-4 * 1 + 2e-4 * (1 + 4) + 3e-4 * tool) / 2;
  EXPECT_NEAR(gimbals.kinetic_energy(angle, rate), expected, 1e-12);
}

}  // namespace
}  // namespace tenon::delta
