// What a flight is made of: references, the pose controller, the rigid body's equations, mission files.
#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "tenon/core/eigen.hpp"
#include "tenon/core/input_error.hpp"
#include "tenon/problems/allocation/pseudo_inverse.hpp"
#include "tenon/problems/allocation/vehicle_file.hpp"
#include "tenon/problems/flight/flight_dae.hpp"
#include "tenon/problems/flight/mission_file.hpp"
#include "tenon/tests/allocation_counter.hpp"
#include "tenon/tests/expect_message.hpp"
#include "tenon/tests/scratch_folder.hpp"

namespace tenon::flight {
namespace {

MakeAllocator linear_allocators() {
  return [](const Vehicle& vehicle) { return std::make_unique<PseudoInverse>(vehicle); };
}

Vector3d random_vector(std::mt19937_64& random, double size) {
  std::uniform_real_distribution<double> any(-size, size);
  return {any(random), any(random), any(random)};
}

/// A mission of one leg, with `more` in front of it.
std::string mission_text(const std::string& more) {
  return more + "[reference]\nkind = \"legs\"\n[[reference.leg]]\nduration = 1\nposition = [1, 0, 0]\n";
}

TEST(Rotations, AVectorOfAtMostHalfATurnComesBack) {
  std::mt19937_64 random(1);
  for (int n = 0; n < 100; ++n) {
    const Vector3d r = n == 0 ? Vector3d(1e-12, 0, 0) : random_vector(random, 1.8);
    const Quaterniond q = rotation_of(r);
    EXPECT_NEAR(q.norm(), 1, 1e-15);
    EXPECT_LE((rotation_vector(q) - r).norm(), 1e-14 + 1e-14 * r.norm());
    EXPECT_LE((rotation_vector(Quaterniond(-q.coeffs())) - r).norm(), 1e-14 + 1e-14 * r.norm()) << "-q is the same rotation";
  }
}

TEST(References, RatesAndAccelerationsAreTheDerivativesOfThePose) {
  constexpr double h = 1e-5;
  for (const std::string& name : builtin_missions()) {
    if (name == "step") continue;  // which has none where it jumps
    const Mission mission = load_mission(name);
    for (double t = 0.0123; t < std::min(40.0, mission.duration); t += 0.317) {
      const PoseReference before = mission.reference.at(t - h), now = mission.reference.at(t), after = mission.reference.at(t + h);
      EXPECT_LE(((after.position - before.position) / (2 * h) - now.velocity).norm(), 1e-8) << name << " " << t;
      EXPECT_LE(((after.velocity - before.velocity) / (2 * h) - now.acceleration).norm(), 1e-7) << name << " " << t;
      const Vector3d turned = rotation_vector(after.attitude * before.attitude.conjugate());  // world axes
      EXPECT_LE((turned / (2 * h) - now.angular_velocity).norm(), 1e-8) << name << " " << t;
      EXPECT_LE(((after.angular_velocity - before.angular_velocity) / (2 * h) - now.angular_acceleration).norm(), 1e-7) << name << " " << t;
      EXPECT_NEAR(now.attitude.norm(), 1, 1e-12);
    }
  }
}

TEST(References, ATumbleTurnsAtItsRate) {
  const Mission mission = load_mission("tumble");
  for (double t = 3; t < 60; t += 0.7) EXPECT_NEAR(mission.reference.at(t).angular_velocity.norm(), std::numbers::pi / 2, 1e-12);
}

TEST(PoseControllers, AtRestWhereItShouldBeAsksForTheWeight) {
  PoseControllerOptions options;
  options.body = {2.5, {0.02, 0.02, 0.02}, 9.80665};
  PoseController controller(options);
  PoseReference reference;
  reference.attitude = rotation_of({0.3, -2, 1});
  PoseMeasurement measurement;
  measurement.attitude = Quaterniond(-reference.attitude.coeffs());
  Wrench wrench;
  for (int k = 0; k < 100; ++k) wrench = controller.tick(&measurement, reference);
  const Vector3d weight = reference.attitude.conjugate() * Vector3d(0, 0, 2.5 * 9.80665);
  EXPECT_LE((wrench.head<3>() - weight).norm(), 1e-12);
  EXPECT_LE(wrench.tail<3>().norm(), 1e-12);
}

TEST(PoseControllers, AnErrorIsAnsweredByThePublishedGains) {
  PoseControllerOptions options;
  options.body = {2.5, {0.02, 0.02, 0.02}, 9.80665};
  options.force.integral = options.torque.integral = 0;
  PoseController controller(options);
  const Vector3d moved(0.01, -0.02, 0.03), turned(0.02, 0.05, -0.01), velocity(0.1, 0, -0.2), rate(0.1, 0.3, 0.2);
  PoseMeasurement measurement{moved, rotation_of(turned), true, velocity, rate};
  const Wrench wrench = controller.tick(&measurement, {});
  const Vector3d force = -100 * moved - 18 * velocity + Vector3d(0, 0, 2.5 * 9.80665);
  EXPECT_LE((wrench.head<3>() - measurement.attitude.conjugate() * force).norm(), 1e-12);
  EXPECT_LE((wrench.tail<3>() - (-1.8 * turned - 0.25 * rate)).norm(), 1e-12);  // w x J w is 0 for a sphere
}

TEST(PoseControllers, TheIntegralEndsAtItsLimitAndStandsStillWhileTheAllocationIsShort) {
  PoseController controller{PoseControllerOptions{}};
  PoseMeasurement measurement;
  measurement.position = {0.001, -0.04, 0};
  for (int k = 0; k < 2400; ++k) controller.tick(&measurement, {});
  EXPECT_EQ(controller.state().force_integral[1], -10);
  controller.reset();
  for (int k = 0; k < 240; ++k) {
    const Wrench wrench = controller.tick(&measurement, {});
    controller.given(wrench, k >= 3);
  }
  EXPECT_LE(controller.state().force_integral[0], 4 * 200 * 0.001 / 240 + 1e-12);
}

TEST(PoseControllers, AMeasurementThatIsLostIsReplacedByWhatIsExpected) {
  PoseControllerOptions options;
  options.body = {2.5, {0.02, 0.02, 0.02}, 9.80665};
  options.actuator_lag = 0;
  PoseController controller(options);
  PoseReference reference;
  reference.acceleration = {0.4, 0, 0.2};
  PoseMeasurement measurement;
  controller.tick(&measurement, reference);
  for (int k = 1; k <= 48; ++k) {  // 0.2 s of the motion that is asked for, unseen
    const double t = k * options.period;
    reference.velocity = t * reference.acceleration;
    reference.position = t * t / 2 * reference.acceleration;
    controller.tick(nullptr, reference);
  }
  EXPECT_LE((controller.state().estimate.position - reference.position).norm(), 1e-9);
  EXPECT_LE((controller.state().estimate.velocity - reference.velocity).norm(), 1e-9);
}

TEST(PoseControllers, TheObserverFindsVelocityAndDisturbanceOfAnAcceleratedBody) {
  const RigidBody body{2.5, {0.02, 0.02, 0.03}, 0};
  constexpr double T = 1.0 / 240;
  const PoseObserver observer(body, 20, T);
  const Vector3d push(0.3, -0.2, 0.1), twist(0, 0, 0.5);
  BodyEstimate estimate;
  for (int k = 1; k <= 480; ++k) {
    const double t = k * T;
    observer.predict(Wrench::Zero(), estimate);
    PoseMeasurement seen;
    seen.position = t * t / 2 * push;
    seen.attitude = rotation_of(t * t / 2 * twist);
    observer.correct(seen, estimate);
  }
  EXPECT_LE((estimate.velocity - 2 * push).norm(), 1e-6);
  EXPECT_LE((estimate.unexplained - push).norm(), 1e-6);
  EXPECT_LE((estimate.rate - 2 * twist).norm(), 1e-6);
  EXPECT_LE((estimate.unexplained_angular - twist).norm(), 1e-6);
}

TEST(PoseControllers, WhatItRemembersIsOneValue) {
  std::mt19937_64 random(3);
  PoseController one{PoseControllerOptions{}}, other{PoseControllerOptions{}};
  Vector numbers(PoseControllerState::kSize), again(PoseControllerState::kSize);
  for (int k = 0; k < 50; ++k) {
    PoseMeasurement seen;
    seen.position = random_vector(random, 0.01);
    seen.attitude = rotation_of(random_vector(random, 0.1));
    one.state().write(numbers);
    other.reset(PoseControllerState::read(numbers));
    other.state().write(again);
    EXPECT_EQ(numbers, again);
    EXPECT_EQ(one.tick(&seen, {}), other.tick(&seen, {}));
    one.given(one.state().asked, k % 2 == 0);
  }
}

TEST(PoseControllers, ATickAllocatesNothing) {
  PoseController controller{PoseControllerOptions{}};
  PoseMeasurement seen;
  AllocationCounter counter;
  for (int k = 0; k < 100; ++k) {
    const Wrench& wrench = controller.tick(k % 3 == 1 ? nullptr : &seen, {});
    controller.given(wrench, false);
  }
  EXPECT_EQ(counter.count(), 0);
}

TEST(PoseControllers, StabilityIsThatOfTheCharacteristicPolynomial) {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> any(0, 1);
  int stable = 0;
  for (int n = 0; n < 1000; ++n) {
    const Gains gains{200 * any(random), 600 * any(random), 40 * any(random), 1};
    const double m = 5 * any(random) + 0.1, T = 0.1 * any(random) + 0.001;
    Eigen::Matrix4d companion = Eigen::Matrix4d::Zero();
    companion.diagonal(1).setOnes();
    companion.row(3) << -gains.integral / (m * T), -gains.proportional / (m * T), -gains.derivative / (m * T), -1 / T;
    const double rightmost = companion.eigenvalues().real().maxCoeff();
    if (std::abs(rightmost) < 1e-9) continue;
    EXPECT_EQ(is_stable(gains, m, T), rightmost < 0) << rightmost;
    stable += rightmost < 0;
  }
  EXPECT_GT(stable, 100);
  EXPECT_LT(stable, 900);
}

TEST(PoseControllers, OptionsThatMakeNoSenseAreNamed) {
  PoseControllerOptions options;
  options.body.mass = 0;
  EXPECT_MESSAGE(PoseController{options}, std::invalid_argument, "mass is 0");
  options = {};
  options.torque.derivative = -1;
  EXPECT_MESSAGE(PoseController{options}, std::invalid_argument, "the derivative gain of the torque is -1");
}

/// A state on the way, its rates large.
DaeState moving_state(const FlightDae& dae, unsigned seed) {
  DaeState s = initial_state_of(dae);
  std::srand(seed);
  s.x += 0.3 * Vector::Random(dae.num_states());
  s.mode.held.head(2 * dae.mission().vehicle.num_rotors()) += 0.05 * Vector::Random(2 * dae.mission().vehicle.num_rotors());
  return s;
}

TEST(FlightEquations, DerivativesSolveTheResidualAndTheJacobianIsItsDerivative) {
  for (const char* name : {"hover", "overload"}) {
    const FlightDae dae(load_mission(name, {"vehicle.model=momav-bench"}), linear_allocators());
    Dae::Workspace workspace = dae.make_workspace();
    DaeState s = moving_state(dae, 1);
    const int nx = dae.num_states(), n = nx + dae.num_algebraics();
    dae.derivatives(s.mode, s.t, s.x, s.u, workspace, s.xdot, s.y);
    Vector F(n), plus(n), minus(n);
    dae.residual(s.mode, DaePoint(s), workspace, F);
    EXPECT_LE(F.lpNorm<Eigen::Infinity>(), 1e-12);
    std::vector<double> values(static_cast<std::size_t>(n * n));
    constexpr double kAlpha = 3, kStep = 1e-6;
    dae.jacobian(s.mode, DaePoint(s), kAlpha, workspace, values);
    const Eigen::Map<Eigen::MatrixXd> J(values.data(), n, n);
    for (int k = 0; k < n; ++k) {
      const auto moved = [&](double step, Vector& out) {
        DaeState at = s;
        if (k < nx)
          at.x[k] += step, at.xdot[k] += kAlpha * step;
        else
          at.y[k - nx] += step;
        dae.residual(at.mode, DaePoint(at), workspace, out);
      };
      moved(kStep, plus);
      moved(-kStep, minus);
      EXPECT_LE((J.col(k) - (plus - minus) / (2 * kStep)).lpNorm<Eigen::Infinity>(), 1e-7) << name << ", column " << k;
    }
  }
}

TEST(FlightEquations, MomentumChangesByForceAndTorqueAlone) {
  const FlightDae dae(load_mission("hover", {"wind.steady=[0,0,0]"}), linear_allocators());
  Dae::Workspace workspace = dae.make_workspace();
  DaeState s = moving_state(dae, 2);
  s.x.segment<4>(3).normalize();
  dae.derivatives(s.mode, s.t, s.x, s.u, workspace, s.xdot, s.y);
  const Vehicle& vehicle = dae.mission().vehicle;
  const auto angular_momentum = [&](const Vector& x) -> Vector3d {  // world axes
    return Quaterniond(x[3], x[4], x[5], x[6]).normalized() * vehicle.inertia.cwiseProduct(x.segment<3>(10));
  };
  const Quaterniond q(s.x[3], s.x[4], s.x[5], s.x[6]);
  constexpr double h = 1e-6;
  const Vector3d change = (angular_momentum(s.x + h * s.xdot) - angular_momentum(s.x - h * s.xdot)) / (2 * h);
  EXPECT_LE((change - q * s.y.tail<3>()).norm(), 1e-8);
  const Vector3d force = q * s.y.head<3>() - vehicle.mass * vehicle.gravity * Vector3d::UnitZ();
  EXPECT_LE((vehicle.mass * s.xdot.segment<3>(7) - force).norm(), 1e-12);
}

TEST(FlightEquations, RotorsGiveWhatTheAllocationTakesThemToGive) {
  for (const std::string& name : builtin_vehicles()) {
    const Vehicle vehicle = load_vehicle(name).vehicle;
    const int n = vehicle.num_rotors();
    std::srand(5);
    const Vector u = Vector::Random(n).cwiseAbs(), a = 4 * Vector::Random(n);
    EXPECT_LE((Rotors(vehicle).wrench(u, a) - LinearAllocation(vehicle).wrench(u, a)).norm(), 1e-12) << name;
  }
}

TEST(MissionFiles, EveryNamedMissionIsThereAndSaysWhatItIs) {
  EXPECT_EQ(builtin_missions(), (std::vector<std::string>{"figure-eight", "hover", "orientation-sweep", "overload", "position-sweep",
                                                          "rotor-failure", "servo-failure", "singular-crossing", "step", "tumble"}));
  for (const std::string& name : builtin_missions()) EXPECT_FALSE(describe_builtin_mission(name).empty());
}

TEST(MissionFiles, FailuresInAVehiclesOwnFileHappenToo) {
  Vehicle vehicle = load_vehicle("momav").vehicle;
  vehicle.rotors[1].fails_at = 3;
  vehicle.rotors[4].servo_sticks_at = 5;
  const ScratchFolder folder;
  folder.write("failing.toml", to_toml(vehicle));
  const Mission mission = load_mission("hover", {"vehicle.model=\"" + folder.path("failing.toml") + "\""});
  ASSERT_EQ(mission.failures.size(), 2u);
  EXPECT_TRUE(mission.failures[0].kind == Failure::Kind::rotor && mission.failures[0].rotor == 1 && mission.failures[0].t == 3);
  EXPECT_TRUE(mission.failures[1].kind == Failure::Kind::servo && mission.failures[1].rotor == 4 && mission.failures[1].t == 5);
}

TEST(MissionFiles, WhatIsWrongIsSaidWithItsPlace) {
  const auto refuse = [](const std::string& text, const std::string& message) {
    SCOPED_TRACE(text);
    EXPECT_MESSAGE(parse_mission(text, "m.toml"), InputError, message);
  };
  refuse("", "m.toml:1:1: there is no [reference]");
  refuse("[reference]\n", "m.toml:1:1: ");
  refuse("[reference]\nkind = \"loops\"\n", "m.toml:2:8: kind is 'loops'");
  refuse("[reference]\nkind = \"legs\"\n", "there is no duration");
  refuse("[reference]\nkind = \"legs\"\n[[reference.leg]]\nposition = [1, 0, 0]\n", "m.toml:3:1: ");
  refuse("[reference]\nkind = \"tumble\"\n[simulation]\nduration = 1\n", "m.toml:1:1: ");
  refuse(mission_text("[vehicle]\nmass = 0\n"), "m.toml:2:8: mass is 0 (expected more than 0)");
  refuse(mission_text("[vehicle]\nmodel = \"momv\"\n"), "m.toml:2:9: unknown vehicle 'momv', the nearest is 'momav'");
  refuse(mission_text("[vehicle]\ninertia = [1, 0, 1]\n"), "the least inertia is 0");
  refuse(mission_text("[controller]\nforce = [100, 200]\n"), "m.toml:2:9: ");
  refuse(mission_text("[controller]\nforce = [100, -200, 1]\n"), "m.toml:2:9: force is [100, -200, 1] (expected no gain below 0)");
  refuse(mission_text("[controller]\nrate = 0\n"), "m.toml:2:8: rate is 0");
  refuse(mission_text("[sensors]\ndrop_out = 1\n"), "m.toml:2:12: drop_out is 1 (expected a probability below 1)");
  refuse(mission_text("[sensors]\ndelay = -1\n"), "m.toml:2:9: delay is -1");
  refuse(mission_text("[[failure]]\nkind = \"rotor\"\nrotor = 7\nt = 1\n"), "m.toml:3:9: rotor is 7 (expected 1 to 6)");
  refuse(mission_text("[[failure]]\nkind = \"rotor\"\nrotor = 1\n"), "m.toml:1:1: ");
  refuse(mission_text("[winds]\n"), "unknown key 'winds'; the nearest known key is 'wind'");
  refuse(mission_text("[simulation]\nlost = -1\n"), "m.toml:2:8: lost is -1 (expected more than 0)");
}

}  // namespace
}  // namespace tenon::flight
