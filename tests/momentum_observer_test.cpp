// A wrench on the tool from what motors and gimbals read and push with.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tenon/problems/delta/controller.hpp"
#include "tenon/problems/delta/encoder.hpp"
#include "tenon/problems/delta/momentum_observer.hpp"
#include "tenon/tests/allocation_counter.hpp"
#include "tenon/tests/delta_robots.hpp"
#include "tenon/tests/expect_message.hpp"

namespace tenon::delta {
namespace {

constexpr double kPeriod = 1e-3;
const Vector3 kTool(0.004, -0.003, 0.04);  // m

Vector3 read_by(int bits, const Vector3& angle) {
  return angle.unaryExpr([bits](double a) { return quantised(a, bits); });
}

/// A robot that follows a circle of 2 cm, two turns a second, while something pushes at its tool; what the observer says after each tick.
class Pushed {
 public:
  Pushed(const Robot& robot, int encoder_bits, double radius)
      : plant_(robot, {.period = kPeriod, .micro_step = 1e-4, .tool = kTool}),
        controller_(robot, {.law = {.form = LawForm::impedance, .stiffness = {1000, 1000, 1000}, .impedance_damping = {50, 50, 50}}}),
        observer_(robot, {.period = kPeriod, .tool = kTool}),
        bits_(encoder_bits),
        radius_(radius) {
    EXPECT_TRUE(plant_.place({radius, 0, 0.4}, {0.1, -0.05, 0.02}));
    controller_.set_tool_reference({0.1, -0.05, 0.02});
  }

  template <class Check>
  void run(const Wrench& push, int ticks, const Check& check) {
    for (int k = 0; k < ticks; ++k) {
      const double phase = 4 * std::numbers::pi * kPeriod * k;
      controller_.set_reference({.position = {radius_ * std::cos(phase), radius_ * std::sin(phase), 0.4}});
      const Command& command = controller_.tick(
          {.angle = plant_.motors(), .rate = plant_.motor_rates(), .gimbal_angle = plant_.gimbals(), .gimbal_rate = plant_.gimbal_rates()});
      ASSERT_TRUE(plant_.step(command.torque, command.gimbal_torque, [&](const ToolMotion&) { return push; }));
      const AllocationCounter counter;
      const Wrench& found =
          observer_.update(read_by(bits_, plant_.motors()), read_by(bits_, plant_.gimbals()), plant_.torque(), plant_.gimbal_torque());
      ASSERT_EQ(counter.count(), 0);
      check(k, found);
    }
  }

  MomentumObserver& observer() { return observer_; }

 private:
  Plant plant_;
  Controller controller_;
  MomentumObserver observer_;
  int bits_;
  double radius_;
};

const Wrench kPush{{3, -2, 4}, {0.02, -0.01, 0.015}};

// 0.3 N at the tool's lever is what the moment may be wrong by.
TEST(MomentumObserver, FindsAConstantWrenchWhileTheRobotMoves) {
  Pushed pushed(load_robot("delta"), 20, 0.02);
  pushed.run(kPush, 1000, [](int k, const Wrench& found) {
    if (k < 100) return;
    EXPECT_LE((found.force - kPush.force).lpNorm<Eigen::Infinity>(), 0.3) << "at tick " << k;
    EXPECT_LE((found.moment - kPush.moment).norm(), 0.3 * kTool.norm()) << "at tick " << k;
  });
}

// With exact angles what is left is that of differences: third derivatives of the motion times T^2.
TEST(MomentumObserver, IsExactButForItsPeriod) {
  std::mt19937_64 random(3);
  for (int n = 0; n < 6; ++n) {
    Robot robot = test_robot(n == 1 ? 0 : n, random);  // not the demonstration robot, which is metres long
    robot.gimbal_inertia = {1e-4, 2e-4, 3e-4};
    robot.torque_limit = robot.gimbal_torque_limit = 1e3;
    Pushed pushed(robot, 0, 0.02);
    Wrench last;
    pushed.run(kPush, 600, [&](int, const Wrench& found) { last = found; });
    EXPECT_LE((last.force - kPush.force).norm(), 5e-3) << "robot " << n;
    EXPECT_LE((last.moment - kPush.moment).norm(), 5e-4) << "robot " << n;
  }
}

TEST(MomentumObserver, RisesAsALowPassOfItsGain) {
  Pushed pushed(load_robot("delta"), 0, 0);
  pushed.run({}, 300, [](int, const Wrench&) {});
  pushed.run(kPush, 40, [](int k, const Wrench& found) {
    const double share = -std::expm1(-200 * kPeriod * k);
    EXPECT_NEAR(found.force[2] / kPush.force[2], share, 0.13) << "at tick " << k;  // half a period late
  });
}

TEST(MomentumObserver, KeepsWhatItSaidWhereTheAnglesAreOfNoPose) {
  Robot robot = load_robot("delta");
  robot.distal_length = 0.2;  // the elbows are farther from one another than the rods reach
  MomentumObserver observer(robot, {});
  const Vector3 apart(0, 0, 0);
  ASSERT_FALSE(forward_kinematics(robot, apart).ok());
  for (int k = 0; k < 5; ++k) EXPECT_EQ(observer.update(apart, Vector3::Zero(), Vector3::Ones(), Vector3::Zero()).force.norm(), 0);
}

TEST(MomentumObserver, RefusesAGainOrPeriodThatIsNotPositive) {
  EXPECT_MESSAGE(MomentumObserver(load_robot("delta"), {.period = 0}), std::invalid_argument, "period is 0");
  EXPECT_MESSAGE(MomentumObserver(load_robot("delta"), {.gain = -1}), std::invalid_argument, "gain is -1");
}

}  // namespace
}  // namespace tenon::delta
