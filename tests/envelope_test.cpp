// The envelope: published efficiencies, symmetry, and boundary points that a dual certificate and an independent solver confirm.
#include "tenon/problems/envelope/envelope.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "tenon/apps/json.hpp"
#include "tenon/core/check_derivatives.hpp"
#include "tenon/core/csv.hpp"
#include "tenon/problems/allocation/linear_allocation.hpp"
#include "tenon/problems/allocation/throttle_map.hpp"
#include "tenon/problems/allocation/vehicle_file.hpp"
#include "tenon/problems/envelope/sphere.hpp"
#include "tenon/solvers/make_solver.hpp"
#include "tenon/tests/run_tenon.hpp"

namespace tenon {
namespace {

using Eigen::Vector3d;

Vehicle vehicle(const std::string& name) { return load_vehicle(name).vehicle; }

/// Its arms exactly across their thrusts, so that the attainable set is exactly convex.
Vehicle squared(Vehicle v) {
  for (Rotor& rotor : v.rotors) {
    if (rotor.tilt) rotor.zero = (rotor.zero - rotor.axis.dot(rotor.zero) * rotor.axis).normalized();
  }
  return v;
}

std::vector<Vector3d> random_directions(int count) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  std::vector<Vector3d> out;
  while (std::ssize(out) < count) out.push_back(Vector3d(normal(random), normal(random), normal(random)).normalized());
  return out;
}

Wrench wrench(const Vector3d& force, const Vector3d& torque) {
  Wrench w;
  w << force, torque;
  return w;
}

/// The three rays of an envelope in one direction: from, along.
std::vector<std::pair<Wrench, Wrench>> rays(const Vehicle& v, const Vector3d& n) {
  const Wrench hover = wrench(v.mass * v.gravity * Vector3d::UnitZ(), Vector3d::Zero());
  return {{Wrench::Zero(), wrench(n, Vector3d::Zero())}, {Wrench::Zero(), wrench(Vector3d::Zero(), n)}, {hover, wrench(Vector3d::Zero(), n)}};
}

/// max n'w over all commands, written anew: tilting rotors that turn freely with linear maps, and fixed ones, throttle in [0, 1].
double support(const Vehicle& v, const Wrench& normal) {
  double sum = 0;
  for (const Rotor& rotor : v.rotors) {
    const auto share = [&](const Vector3d& d) {
      return normal.head<3>().dot(rotor.thrust[1] * d) +
             normal.tail<3>().dot(rotor.position.cross(rotor.thrust[1] * d) + rotor.spin * rotor.torque[1] * d);
    };
    sum += rotor.tilt ? std::hypot(share(rotor.zero), share(rotor.axis.cross(rotor.zero))) : std::max(0.0, share(rotor.zero));
  }
  return sum;
}

/// The extreme of a quantity over all directions, from a coarse grid.
double extreme(Envelope& envelope, double EnvelopePoint::*quantity, double sign) {
  const auto value = [&](const Vector3d& n) { return sign * (envelope.at(n).*quantity); };
  SphereExtreme best{-kInfinity<double>, Vector3d::UnitZ()};
  for (const Vector3d& n : sphere_grid(600)) {
    if (const double at = value(n); at > best.value) best = {at, n};
  }
  return sign * climb(value, best, 0.1).value;
}

TEST(Envelope, MomavHoversAsEfficientlyAsPublished) {
  Envelope momav(vehicle("momav"));
  EXPECT_NEAR(extreme(momav, &EnvelopePoint::X1, -1), std::sqrt(2.0 / 3), 1e-4);
  EXPECT_NEAR(extreme(momav, &EnvelopePoint::X1, 1), 1, 1e-4);
  EXPECT_NEAR(extreme(momav, &EnvelopePoint::X2, -1), 2.0 / 3, 1e-4);
  EXPECT_NEAR(extreme(momav, &EnvelopePoint::X2, 1), std::sqrt(2.0 / 3), 1e-4);
}

TEST(Envelope, MomavHasTheSymmetryOfItsOctahedron) {
  const Vehicle v = vehicle("momav");
  Eigen::Matrix3d axes;  // arms 1, 3 and 5 point to three corners of the octahedron, at right angles but for the table's rounding
  for (int k = 0; k < 3; ++k) axes.col(k) = v.rotors[static_cast<std::size_t>(2 * k)].axis;
  ASSERT_LT((axes.transpose() * axes - Eigen::Matrix3d::Identity()).norm(), 1e-5);
  Envelope envelope(v);
  for (const Vector3d& n : random_directions(12)) {
    const EnvelopePoint first = envelope.at(axes * n);
    std::array<int, 3> order{0, 1, 2};
    do {
      for (int signs = 0; signs < 8; ++signs) {
        Vector3d turned;
        for (int k = 0; k < 3; ++k) turned[k] = (signs >> k & 1 ? -1 : 1) * n[order[static_cast<std::size_t>(k)]];
        const EnvelopePoint other = envelope.at(axes * turned);
        EXPECT_NEAR(other.X1, first.X1, 1e-5);
        EXPECT_NEAR(other.X2, first.X2, 1e-5);
      }
    } while (std::next_permutation(order.begin(), order.end()));
  }
}

TEST(Envelope, EveryBoundaryPointIsProvedByItsNormal) {
  for (const std::string name : {"momav", "tilt-quad", "fixed-tilt-hexa"}) {
    const Vehicle v = squared(vehicle(name));
    const AttainableSet set(v.rotors);
    for (const Vector3d& n : random_directions(200)) {
      for (const auto& [from, along] : rays(v, n)) {
        const AttainableSet::Answer answer = set.farthest(from, along);
        ASSERT_TRUE(answer.solved) << name;
        const double bound = (support(v, answer.normal) - answer.normal.dot(from)) / answer.normal.dot(along);
        EXPECT_LE(bound - answer.length, 1e-8 * std::max(1.0, answer.length)) << name;
        EXPECT_GE(bound - answer.length, -1e-8 * std::max(1.0, answer.length)) << name;
      }
    }
  }
}

TEST(Envelope, TheCommandsGiveTheWrenchWithinTheLimits) {
  Vehicle v = vehicle("momav");
  for (Rotor& rotor : v.rotors) {
    rotor.angle_lower = -1;
    rotor.angle_upper = 1.5;
  }
  for (const Vehicle& each : {vehicle("momav"), vehicle("momav-bench"), v}) {
    const AttainableSet set(each.rotors);
    const LinearAllocation maps(each);
    for (const Vector3d& n : random_directions(50)) {
      for (const auto& [from, along] : rays(each, n)) {
        const AttainableSet::Answer answer = set.farthest(from, along);
        ASSERT_TRUE(answer.solved);
        Vector u(6), a(6);
        for (int i = 0; i < 6; ++i) {
          const auto k = static_cast<std::size_t>(i);
          const RotorReach::Command command = set.rotors()[k].command(answer.y[k]);
          u[i] = command.throttle;
          a[i] = command.angle;
          EXPECT_GE(a[i], each.rotors[k].angle_lower);
          EXPECT_LE(a[i], each.rotors[k].angle_upper);
        }
        EXPECT_GE(u.minCoeff(), 0);
        EXPECT_LE(u.maxCoeff(), 1);
        EXPECT_LT((maps.wrench(u, a) - from - answer.length * along).lpNorm<Eigen::Infinity>(), 1e-6);
        EXPECT_LT(set.support(answer.normal) - answer.normal.dot(from) - answer.length * answer.normal.dot(along), 1e-4);
      }
    }
  }
}

TEST(Envelope, IpoptFindsTheSameBoundary) {
  const auto solvers = list_solvers();
  if (std::ranges::none_of(solvers, [](const auto& s) { return s.name == "ipopt" && s.available; })) GTEST_SKIP() << "without Ipopt";
  for (const std::string name : {"momav", "momav-bench", "fixed-tilt-hexa"}) {
    const Vehicle v = vehicle(name);
    const AttainableSet set(v.rotors);
    RayProgram program(v.rotors, RayProgram::Aim::farthest);
    const auto ipopt = make_solver("ipopt", program);
    for (const Vector3d& n : random_directions(12)) {
      for (const auto& [from, along] : rays(v, n)) {
        const AttainableSet::Answer answer = set.farthest(from, along);
        program.set_ray(from, along);
        Point point(13, 6);
        for (std::size_t i = 0; i < 6; ++i) {  // from somewhere near, for the program is not convex
          const RotorReach::Command command = set.rotors()[i].command(answer.y[i]);
          point.x[static_cast<Eigen::Index>(i)] = 0.9 * command.throttle + 0.05;
          point.x[static_cast<Eigen::Index>(6 + i)] = command.angle + (v.rotors[i].tilt ? 0.1 : 0);
        }
        ASSERT_TRUE(succeeded(ipopt->solve(point).status)) << name;
        EXPECT_NEAR(point.x[12], answer.length, 2e-6 * std::max(1.0, answer.length)) << name;
      }
    }
  }
}

TEST(Envelope, TheLeastEffortOfANonlinearThrustIsThatOfTheGeneralSolver) {
  const Vehicle v = vehicle("momav-bench");
  const AttainableSet set(v.rotors);
  RayProgram program(v.rotors, RayProgram::Aim::least_effort);
  const auto solver = make_solver("newton-kkt", program);
  for (const Vector3d& n : random_directions(24)) {
    const Wrench hover = wrench(v.mass * v.gravity * n, Vector3d::Zero());
    const AttainableSet::Answer answer = set.least_effort(hover);
    ASSERT_TRUE(answer.solved);
    Vector u(6);
    Point point(13, 6);
    for (std::size_t i = 0; i < 6; ++i) {
      const RotorReach::Command command = set.rotors()[i].command(answer.y[i]);
      u[static_cast<Eigen::Index>(i)] = command.throttle;
      point.x[static_cast<Eigen::Index>(i)] = 0.5;
      point.x[static_cast<Eigen::Index>(6 + i)] = command.angle + 0.1;
    }
    program.set_ray(hover);
    const Result result = solver->solve(point);
    ASSERT_TRUE(succeeded(result.status));
    EXPECT_NEAR(u.squaredNorm(), result.objective, 1e-7);
  }
}

TEST(Envelope, TheRayProgramsDerivativesAreRight) {
  Vehicle v = vehicle("momav");
  v.rotors[0].thrust = {0.1, 3, 2, 8};
  v.rotors[1].torque = {0, 0.1, 0.2};
  v.rotors[2].axis = Vector3d(1, 2, 3).normalized();
  for (const auto aim : {RayProgram::Aim::farthest, RayProgram::Aim::least_effort}) {
    RayProgram program(v.rotors, aim);
    program.set_ray(wrench({1, 2, 3}, {0.1, 0.2, 0.3}), wrench({0, 0.6, 0.8}, {0.1, 0, 0}));
    const Vector x = Vector::LinSpaced(13, 0.2, 1.3);
    EXPECT_TRUE(check_derivatives(program, x, 0.7, Vector::LinSpaced(6, -1, 2)).passed(1e-7));
  }
}

TEST(Envelope, MomavHoversInAnyOrientationWithoutAnyOneRotor) {
  const Vehicle v = vehicle("momav");
  for (int failed = 0; failed < 6; ++failed) {
    Envelope envelope(v, failed);
    for (const Vector3d& n : sphere_grid(300)) {
      const EnvelopePoint at = envelope.at(n);
      EXPECT_GT(at.force, 1.5 * v.mass * v.gravity);
      EXPECT_GT(at.X1, 0.73);
      EXPECT_GT(at.X2, 0.44);
    }
  }
}

TEST(Envelope, AVehicleWithoutFullRankSaysWhatItCannotDo) {
  const Vehicle v = vehicle("flat-hexa");
  Envelope envelope(v);
  EXPECT_EQ(envelope.unreachable(), (std::vector<std::string>{"force along body x", "force along body y"}));
  const EnvelopePoint up = envelope.at(Vector3d::UnitZ()), sideways = envelope.at(Vector3d::UnitX()), down = envelope.at(-Vector3d::UnitZ());
  EXPECT_NEAR(up.force, 66, 1e-6);
  EXPECT_NEAR(up.X1, 1, 1e-9);
  EXPECT_EQ(sideways.force, 0);
  EXPECT_TRUE(std::isnan(sideways.X1));
  EXPECT_NEAR(down.force, 0, 1e-6);
  EXPECT_NEAR(sideways.torque, 0, 1e-6);
  EXPECT_GT(sideways.torque_hover, 0.3);
  EXPECT_EQ(Envelope(vehicle("momav")).unreachable(), std::vector<std::string>());
}

TEST(Envelope, ASetThatIsNotConvexIsBracketed) {
  Vehicle v = vehicle("momav");
  for (Rotor& rotor : v.rotors) {
    rotor.throttle_lower = 0.05;
    rotor.angle_lower = -2.5;
    rotor.angle_upper = 2.5;
    rotor.torque = {0, 0.15, 0.03};
  }
  Envelope envelope(v, -1, [](const Nlp& program) { return make_solver("newton-kkt", program); });
  ASSERT_FALSE(envelope.is_convex());
  Envelope wider(vehicle("momav"));
  for (const Vector3d& n : random_directions(20)) {
    const EnvelopePoint at = envelope.at(n), around = wider.at(n);
    EXPECT_GT(at.force, 0.6 * around.force);
    EXPECT_LT(at.force, 1.02 * around.force);
    EXPECT_GT(at.force + at.force_gap, at.force);
  }
}

TEST(EnvelopeCli, TheMapAndTheSummarySayTheSame) {
  const ScratchFolder folder;
  const Ended run = run_tenon(folder, "envelope momav --rows 60 --output env.csv --json");
  ASSERT_EQ(run.code, 0) << run.err;
  const Json json = Json::parse(run.out, "stdout");
  EXPECT_EQ(json.at("schema").number(), 1);
  EXPECT_EQ(json.at("directions").number(), 60);
  ASSERT_EQ(json.at("failed").elements().size(), 6U);
  EXPECT_EQ(json.at("failed").elements()[2].at("rotor").number(), 3);
  const CsvTable table = read_csv(folder.path("env.csv"));
  ASSERT_EQ(table.rows(), 60);
  EXPECT_EQ(table.names.size(), 3U + 7 * 5);
  for (const std::string name : {"X1", "X2", "force", "torque", "torque_hover"}) {
    const auto [least, most] = std::ranges::minmax(table[name]);
    EXPECT_LE(json.at(name).at("min").number(), least + 1e-12);
    EXPECT_GE(json.at(name).at("max").number(), most - 1e-12);
    EXPECT_TRUE(table.has(name + "_failed6"));
  }
}

TEST(EnvelopeCli, WhatCannotBeHadIsNamedAndWhatIsWrongIsRefused) {
  const ScratchFolder folder;
  EXPECT_NE(run_tenon(folder, "envelope flat-hexa --rows 10").out.find("no command gives force along body x, force along body y"),
            std::string::npos);
  const Ended few = run_tenon(folder, "envelope momav --rows 5 --output env.csv");
  EXPECT_EQ(few.code, 2);
  EXPECT_TRUE(is_one_line(few.err, "tenon: --rows is 5 (expected at least 6 directions)")) << few.err;
  EXPECT_EQ(run_tenon(folder, "envelope momaw").code, 2);
  EXPECT_EQ(run_tenon(folder, "envelope momav --rows 10 --output none/env.csv").code, 2);
  EXPECT_FALSE(folder.has("env.csv"));
}

}  // namespace
}  // namespace tenon
