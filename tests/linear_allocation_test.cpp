// The linear solution: exact for linear maps, at the effort bound, honest about what a vehicle cannot do.
#include "tenon/problems/allocation/linear_allocation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tenon/problems/allocation/pseudo_inverse.hpp"
#include "tenon/problems/allocation/vehicle_file.hpp"

namespace tenon {
namespace {

Wrench random_wrench(const Vehicle& vehicle, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  Wrench w;
  for (double& v : w) v = normal(random);
  w.head<3>() *= vehicle.mass * vehicle.gravity / w.head<3>().norm();
  w.tail<3>() *= 0.5;
  return w;
}

TEST(LinearAllocation, MeetsEveryWrenchOfATiltingVehicle) {
  std::mt19937_64 random(3);
  for (const char* name : {"momav", "momav-bench", "tilt-quad"}) {
    const Vehicle vehicle = load_vehicle(name).vehicle;
    const LinearAllocation linear(vehicle);
    EXPECT_EQ(linear.rank(), 6);
    EXPECT_TRUE(linear.unreachable_directions().empty());
    const Vector zero = Vector::Zero(vehicle.num_rotors());
    Vector u = zero, a = zero;
    for (int k = 0; k < 1000; ++k) {
      const Wrench w = 0.6 * random_wrench(vehicle, random);
      linear.solve(w, zero, u, a);
      if (u.maxCoeff() > 1) continue;  // a thrust map is continued straight beyond its range
      EXPECT_LT((linear.wrench(u, a) - w).lpNorm<Eigen::Infinity>(), 1e-12) << name;
    }
  }
}

TEST(LinearAllocation, TheEffortIsAtItsBound) {
  std::mt19937_64 random(4);
  const Vehicle vehicle = load_vehicle("tilt-quad").vehicle;
  const LinearAllocation linear(vehicle);
  Vector u(4), a = Vector::Zero(4);
  for (int k = 0; k < 100; ++k) {
    const Wrench w = random_wrench(vehicle, random);
    linear.solve(w, a, u, a);
    EXPECT_NEAR(u.squaredNorm(), linear.effort_lower_bound(w), 1e-12 * u.squaredNorm());
  }
}

TEST(LinearAllocation, AnglesStayInTheTurnOfThePreviousOnes) {
  const Vehicle vehicle = load_vehicle("momav").vehicle;
  const LinearAllocation linear(vehicle);
  const Wrench w = (Wrench() << 0, 0, 24.5, 0, 0, 0).finished();
  Vector u(6), a(6), turned(6);
  linear.solve(w, Vector::Zero(6), u, a);
  linear.solve(w, Vector::Constant(6, 62.8), u, turned);
  EXPECT_LT((turned - Vector::Constant(6, 62.8)).cwiseAbs().maxCoeff(), M_PI + 1e-12);
  EXPECT_LT((linear.wrench(u, turned) - w).lpNorm<Eigen::Infinity>(), 1e-12);
}

TEST(LinearAllocation, NamesWhatAFlatVehicleCannotDo) {
  const Vehicle vehicle = load_vehicle("flat-hexa").vehicle;
  const LinearAllocation linear(vehicle);
  EXPECT_EQ(linear.rank(), 4);
  EXPECT_EQ(linear.unreachable_directions(), (std::vector<std::string>{"force along body x", "force along body y"}));
  const Wrench w = (Wrench() << 1, 2, 20, .1, -.2, .05).finished();
  Vector u(6), a(6);
  linear.solve(w, Vector::Zero(6), u, a);
  const Wrench error = linear.wrench(u, a) - w;
  EXPECT_NEAR(error[0], -1, 1e-12);
  EXPECT_NEAR(error[1], -2, 1e-12);
  EXPECT_LT(error.tail<4>().lpNorm<Eigen::Infinity>(), 1e-12);
}

TEST(LinearAllocation, AFixedTiltedVehicleIsFullyActuated) {
  const Vehicle vehicle = load_vehicle("fixed-tilt-hexa").vehicle;
  const LinearAllocation linear(vehicle);
  EXPECT_EQ(linear.rank(), 6);
  const Wrench w = (Wrench() << .5, -.3, 20, .1, .1, .05).finished();
  Vector u(6), a(6);
  linear.solve(w, Vector::Zero(6), u, a);
  EXPECT_LT((linear.wrench(u, a) - w).lpNorm<Eigen::Infinity>(), 1e-12);
}

TEST(LinearAllocation, GoesOnWithoutAFailedRotorAndWithAStuckServo) {
  std::mt19937_64 random(5);
  const Vehicle vehicle = load_vehicle("momav").vehicle;
  LinearAllocation linear(vehicle);
  linear.fail_rotor(2);
  linear.stick_servo(4, 0.3);
  const Vector previous = Vector::Constant(6, 0.1);
  Vector u(6), a(6);
  const Wrench w = random_wrench(vehicle, random);
  linear.solve(w, previous, u, a);
  EXPECT_EQ(u[2], 0);
  EXPECT_EQ(a[2], 0.1);
  EXPECT_EQ(a[4], 0.3);
  EXPECT_LT((linear.wrench(u, a) - w).lpNorm<Eigen::Infinity>(), 1e-12);
}

TEST(PseudoInverse, KeepsThrottleAndRateLimitsAndReportsWhatThatCosts) {
  std::mt19937_64 random(6);
  const Vehicle vehicle = load_vehicle("momav").vehicle;
  PseudoInverse allocator(vehicle);
  const double dt = 1.0 / 240;
  Vector last = Vector::Zero(6);
  for (int k = 0; k < 500; ++k) {
    const Wrench w = random_wrench(vehicle, random);
    const Allocation& allocation = allocator.allocate(w, dt);
    EXPECT_GE(allocation.throttle.minCoeff(), 0);
    EXPECT_LE(allocation.throttle.maxCoeff(), 1);
    if (k > 0) {
      EXPECT_LE((allocation.angle - last).cwiseAbs().maxCoeff(), 2 * M_PI * dt * (1 + 1e-12));
    }
    const LinearAllocation exact(vehicle);
    EXPECT_TRUE((exact.wrench(allocation.throttle, allocation.angle) - w).isApprox(allocation.error, 1e-9));
    EXPECT_EQ(allocation.status, allocation.residual < 1e-6 ? AllocationStatus::solved : AllocationStatus::best_effort);
    last = allocation.angle;
  }
}

TEST(PseudoInverse, MeetsTheWrenchWhereTheTorqueIsNoFixedShareOfTheThrust) {
  Vehicle vehicle = load_vehicle("momav-bench").vehicle;
  for (Rotor& rotor : vehicle.rotors) rotor.torque = {0, 0.05, 0.2};
  PseudoInverse allocator(vehicle);
  const Allocation& allocation = allocator.allocate((Wrench() << 1, 2, 24, .3, -.2, .1).finished(), 1.0 / 240);
  EXPECT_EQ(allocation.status, AllocationStatus::solved);
  EXPECT_LT(allocation.error.lpNorm<Eigen::Infinity>(), 1e-9);
}

}  // namespace
}  // namespace tenon
