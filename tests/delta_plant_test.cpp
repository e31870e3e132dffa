// The plant of a control loop against the same robot as a DAE: two derivations, two integrators, one motion.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tenon/problems/delta/plant.hpp"
#include "tenon/problems/delta/scene_dae.hpp"
#include "tenon/solvers/make_integrator.hpp"
#include "tenon/tests/allocation_counter.hpp"
#include "tenon/tests/delta_robots.hpp"
#include "tenon/tests/expect_message.hpp"

namespace tenon::delta {
namespace {

const auto kNoForce = [](const ToolMotion&) { return Wrench{}; };
const Vector3 kStart(0.03, -0.02, 0.4);

Vector3 holding_torque(const Robot& robot, const Vector3& wrist) {
  const Configuration at(inverse_kinematics(robot, wrist).q);
  return gravity_torque(ArmConstants(robot), at, Motion(robot, at));
}

/// The wrist's acceleration by the index-1 form, J_v v' + Jdot_v v.
Vector3 acceleration_of_dae(const Robot& robot, const Configuration& at, const Vector9& v, const Vector3& u, const Vector3& f) {
  Vector3 bias = Vector3::Zero();
  for (int i = 0; i < kArms; ++i) bias += to_world(i, at[i].bias(robot, v.segment<3>(3 * i))) / 3;
  return simulation_jacobian(robot, at) * acceleration(robot, ArmConstants(robot), at, v, u, f).v_rate + bias;
}

TEST(WristDynamics, TheAccelerationIsThatOfTheIndexOneForm) {
  std::mt19937_64 random(7);
  for (int n = 0; n < 12; ++n) {
    const Robot robot = test_robot(n, random);
    for (int pose = 0; pose < 10; ++pose) {
      const Configuration at(random_configuration(robot, random));
      const Vector3 velocity = random_vector(random, 1), u = random_vector(random, 2), f = random_vector(random, 5);
      const Vector9 v = rates_of_wrist(robot, at, velocity);
      EXPECT_LE((closure_jacobian(robot, at) * v).norm(), 1e-13 * (1 + v.norm()));
      const Vector3 expected = acceleration_of_dae(robot, at, v, u, f);
      EXPECT_LE((wrist_acceleration(robot, ArmConstants(robot), at, velocity, u, f) - expected).norm(), 1e-10 * (1 + expected.norm()));
    }
  }
}

TEST(WristDynamics, IsRegularAtTypeTwo) {
  const Robot robot = load_robot("delta");
  Configuration at;
  const auto det_a = [&](double z) { return place_wrist(robot, {-0.42, -0.16, z}, at) < 0 ? Motion(robot, at).det_a : std::nan(""); };
  double below = 0.17, above = 0.21;
  ASSERT_LT(det_a(below), 0);
  ASSERT_GT(det_a(above), 0);
  while (above - below > 1e-15) (det_a((above + below) / 2) > 0 ? above : below) = (above + below) / 2;
  ASSERT_LE(std::abs(det_a(below)), 1e-14);
  const Vector3 velocity(0.1, -0.2, 0.3), u(1, 2, -1), f(1, 0, 2);
  const Vector3 expected = acceleration_of_dae(robot, at, rates_of_wrist(robot, at, velocity), u, f);
  EXPECT_LE((wrist_acceleration(robot, ArmConstants(robot), at, velocity, u, f) - expected).norm(), 1e-10 * expected.norm());
}

struct TorqueRun {
  Scene scene;
  PlantOptions options;

  /// The farthest that the plant's wrist (m) and angles (rad), and its rates (rad/s), are from those of IDA, tick by tick; the torques
  /// swing about those that hold the weight.
  std::pair<double, double> distance_from_ida(int ticks) const {
    const SceneDae dae(scene);
    IntegratorOptions precise;
    precise.rtol = 1e-10;
    precise.atol = 1e-12;
    DaeState state = initial_state_of(dae);
    const auto ida = make_integrator("ida", dae, precise);
    Plant plant(scene.robot, options);
    EXPECT_TRUE(plant.place(scene.position, {0, 0, 0}, scene.velocity));
    const Vector3 holding = holding_torque(scene.robot, scene.position);
    double position = 0, rate = 0;
    for (int k = 0; k < ticks; ++k) {
      const Vector3 torque = holding + 0.05 * Vector3(std::sin(0.1 * k), std::cos(0.07 * k), -std::sin(0.13 * k));
      state.u = torque;
      EXPECT_EQ(ida->advance(state, (k + 1) * options.period).status, IntegrationStatus::reached);
      EXPECT_TRUE(plant.step(torque, {0, 0, 0}, [&](const ToolMotion& tool) {
        Wrench wrench;
        for (const Contact& c : scene.contacts) {
          const double gap = c.normal.dot(tool.position) + c.offset, gap_rate = c.normal.dot(tool.velocity);
          if (gap < 0) wrench.force += std::max(0.0, -c.stiffness * gap - c.damping * gap_rate) * c.normal;
        }
        return wrench;
      }));
      EXPECT_LE(plant.closure().lpNorm<Eigen::Infinity>(), 1e-12);
      position = std::max(position, (plant.wrist() - wrist_position(scene.robot, Configuration(Vector9(state.x.head<9>())))).norm());
      position = std::max(position, (plant.angles() - state.x.head<9>()).norm());
      rate = std::max(rate, (plant.rates() - state.x.segment<9>(9)).norm());
    }
    return {position, rate};
  }
};

TorqueRun free_run() {
  TorqueRun run;
  run.scene.robot = load_robot("delta");
  run.scene.position = kStart;
  run.scene.velocity = {0.1, 0.2, -0.1};
  return run;
}

TEST(DeltaPlant, MovesFreelyAsTheDaeUnderIdaDoes) {
  const auto [position, rate] = free_run().distance_from_ida(400);
  EXPECT_LE(position, 1e-7);
  EXPECT_LE(rate, 1e-6);
}

TEST(DeltaPlant, BouncesOffASpringWallAsTheDaeUnderIdaDoes) {
  TorqueRun run = free_run();
  run.scene.velocity = {0, 0.02, 0.05};
  run.scene.contacts = {{.name = "wall", .stiffness = 2e5, .damping = 0, .normal = {0, 0, -1}, .offset = 0.402}};
  const auto [position, rate] = run.distance_from_ida(200);
  EXPECT_LE(position, 1e-6);
  EXPECT_LE(rate, 1e-3);
}

TEST(DeltaPlant, AForceThatJumpsCostsAMicroStepOfIt) {
  constexpr double kDamping = 100, kSpeed = 0.05, kMass = 0.5;  // N s/m; m/s; kg, less than the wrist and what moves with it
  constexpr int kTicks = 100;
  TorqueRun run = free_run();
  run.scene.velocity = {0, 0.02, kSpeed};
  run.scene.contacts = {{.name = "wall", .stiffness = 2e5, .damping = kDamping, .normal = {0, 0, -1}, .offset = 0.402}};
  for (const double micro_step : {2e-5, 5e-6}) {
    run.options.micro_step = micro_step;
    const double speed = kDamping * kSpeed / kMass * micro_step, distance = speed * kTicks * run.options.period;  // of the wrist, m/s, m
    EXPECT_LE(run.distance_from_ida(kTicks).first, 10 * distance) << micro_step;  // an angle is up to 10 rad/m of it
  }
}

TEST(DeltaPlant, ErrorsFallWithTheFourthPowerOfTheMicroStep) {
  const auto end = [](double micro_step) {
    Plant plant(load_robot("delta"), {.period = 0.3, .micro_step = micro_step, .tool = {0, 0, 0.04}});
    plant.place(kStart, {0.1, 0.2, 0.3}, {0.1, 0.2, -0.1}, {3, -2, 1});
    plant.step(holding_torque(plant.robot(), kStart), {1e-3, 0, -1e-3}, [](const ToolMotion& tool) {
      return Wrench{-300 * (tool.position - Vector3(0.03, 0, 0.44)), {0, 0, 0}};
    });
    return plant.tool().position;
  };
  const Vector3 exact = end(1e-4);
  EXPECT_NEAR(std::log2((end(6e-3) - exact).norm() / (end(3e-3) - exact).norm()), 4, 0.4);
}

TEST(DeltaPlant, ASpringAtTheToolGivesBackAllOfItsEnergy) {
  Robot robot = load_robot("delta");
  robot.damping.setZero();
  Plant plant(robot, {.tool = {0.01, -0.02, 0.04}});
  ASSERT_TRUE(plant.place(kStart, {0.1, 0.2, 0.3}, {0.1, 0.2, -0.1}, {3, -2, 1}));
  const Vector3 anchor = plant.tool().position + Vector3(1e-3, 0, 2e-3), axis(0.6, 0, 0.8);
  constexpr double kStiffness = 2e3, kTurning = 0.02;
  // potential: k/2 |p - anchor|^2 - c axis . (R axis)
  const auto force = [&](const ToolMotion& tool) {
    return Wrench{-kStiffness * (tool.position - anchor), kTurning * Vector3(tool.attitude * axis).cross(axis)};
  };
  const auto energy = [&] {
    const ToolMotion tool = plant.tool();
    return plant.energy() + kStiffness / 2 * (tool.position - anchor).squaredNorm() - kTurning * axis.dot(tool.attitude * axis);
  };
  const double before = energy();
  double turned = 0;
  for (int k = 0; k < 200; ++k) {
    ASSERT_TRUE(plant.step({0, 0, 0}, {0, 0, 0}, force));
    EXPECT_NEAR(energy(), before, 1e-10);
    turned = std::max(turned, (plant.gimbals() - Vector3(0.1, 0.2, 0.3)).norm());
  }
  EXPECT_GT(turned, 0.1);
}

TEST(DeltaPlant, TorquesTakeTheirWorkAndFrictionGivesNoneBack) {
  Plant plant(load_robot("delta"), {.period = 1e-4});
  ASSERT_TRUE(plant.place(kStart, {0, 0, 0}, {0.1, 0.2, -0.1}, {1, 1, 1}));
  const Vector3 torque = holding_torque(plant.robot(), kStart), turning(1e-3, -1e-3, 2e-3);
  double work = plant.energy();
  const auto power = [&] {
    double friction = 0;
    for (int i = 0; i < kArms; ++i) {
      const Vector3 v = plant.rates().segment<3>(3 * i);
      friction += plant.robot().damping.dot(v.cwiseProduct(v));
    }
    return torque.dot(plant.motor_rates()) + turning.dot(plant.gimbal_rates()) - friction;
  };
  for (int k = 0; k < 1000; ++k) {
    const double begin = power();
    ASSERT_TRUE(plant.step(torque, turning, kNoForce));
    work += 0.5e-4 * (begin + power());  // the trapezoidal rule's error is 1e-8 of the work
    EXPECT_NEAR(plant.energy(), work, 1e-8);
  }
}

TEST(DeltaPlant, TorquesAreCutToTheRobotsLimits) {
  Plant plant(load_robot("delta"), {});
  ASSERT_TRUE(plant.place(kStart, {0, 0, 0}));
  EXPECT_TRUE(plant.step({9, -9, 1}, {1, -1, 0.1}, kNoForce));
  EXPECT_EQ(plant.torque(), Vector3(4, -4, 1));
  EXPECT_EQ(plant.gimbal_torque(), Vector3(0.2, -0.2, 0.1));
}

TEST(DeltaPlant, SaysWhereTheArmsDoNotReachAndStaysWhereItWas) {
  Plant plant(load_robot("delta"), {});
  ASSERT_TRUE(plant.place(kStart, {0, 0, 0}));
  EXPECT_FALSE(plant.place({0, 0, 0.7}, {0, 0, 0}));
  EXPECT_EQ(plant.wrist(), kStart);
  EXPECT_FALSE(plant.step({0, 0, 0}, {0, 0, 0}, [](const ToolMotion&) { return Wrench{{std::nan(""), 0, 0}, {0, 0, 0}}; }));
  EXPECT_EQ(plant.wrist(), kStart);
  bool goes_on = true;
  for (int k = 0; k < 2000 && goes_on; ++k)
    goes_on = plant.step({0, 0, 0}, {0, 0, 0}, [](const ToolMotion&) { return Wrench{{0, 0, 50}, {0, 0, 0}}; });
  EXPECT_FALSE(goes_on);  // pulled to the end of its reach
  EXPECT_TRUE(plant.angles().allFinite());
}

TEST(DeltaPlant, ATickAllocatesNothingAndACopyRepeatsIt) {
  Plant plant(load_robot("delta"), {.tool = {0, 0, 0.04}});
  ASSERT_TRUE(plant.place(kStart, {0.1, 0, 0}));
  Plant other = plant;
  const auto wall = [](const ToolMotion& tool) { return Wrench{{0, 0, -2e5 * std::max(0.0, tool.position[2] - 0.44)}, {0, 0, 0}}; };
  AllocationCounter counter;
  for (int k = 0; k < 10; ++k) plant.step({-0.4, -0.4, -0.4}, {0, 0, 0}, wall);
  EXPECT_EQ(counter.count(), 0);
  for (int k = 0; k < 10; ++k) other.step({-0.4, -0.4, -0.4}, {0, 0, 0}, wall);
  EXPECT_EQ(plant.wrist(), other.wrist());
  EXPECT_EQ(plant.angles(), other.angles());
}

TEST(DeltaPlant, RefusesWhatMakesNoSense) {
  Robot robot = load_robot("delta");
  EXPECT_MESSAGE(Plant(robot, {.period = 0}), std::invalid_argument, "period is 0");
  EXPECT_MESSAGE(Plant(robot, {.micro_step = -1}), std::invalid_argument, "micro_step is -1");
  robot.proximal_length = -1;
  EXPECT_MESSAGE(Plant(robot, {}), std::invalid_argument, "proximal_length is -1 m (expected more than 0)");
}

}  // namespace
}  // namespace tenon::delta
