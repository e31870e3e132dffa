// The allocation problem and its ticks: derivatives, the two kinds of linear algebra, determinism, no allocation, failures, whole turns.
#include <gtest/gtest.h>

#include "tenon/apps/allocators/allocation_row.hpp"
#include "tenon/core/as_nlp.hpp"
#include "tenon/core/check_derivatives.hpp"
#include "tenon/problems/allocation/wrench_allocation.hpp"
#include "tenon/solvers/make_solver.hpp"
#include "tenon/tests/allocation_counter.hpp"
#include "tenon/tests/allocation_run.hpp"

namespace tenon {
namespace {

constexpr double kFullRate = 2 * M_PI;

/// At random points with some throttles and rates beyond their soft limits, none within 1e-3 of a kink.
template <int N>
void obeys_the_derivative_law(const Vehicle& vehicle) {
  constexpr double kFromKink = 1e-3;
  WrenchAllocation<N> problem(vehicle);
  const AsNlp<WrenchAllocation<N>> nlp(problem);
  RandomNumbers random(7);
  const auto away_from = [](double v, double kink, double distance) { return std::abs(v - kink) < distance ? kink + 2 * distance : v; };
  const AllocationWeights& w = vehicle.weights;
  for (int repetition = 0; repetition < 20; ++repetition) {
    Vector x(2 * N), previous(N), lambda(6);
    for (int i = 0; i < N; ++i) {
      x[i] = away_from(away_from(random.uniform(-0.1, 1.1), w.throttle_soft_lower, kFromKink), w.throttle_soft_upper, kFromKink);
      x[N + i] = random.uniform(-10, 10);
      double rate = random.uniform(-8, 8);
      for (const double kink : {-w.angle_rate_soft, w.angle_rate_soft}) {
        if (std::isfinite(kink)) rate = away_from(rate, kink, 0.1);
      }
      previous[i] = x[N + i] - 0.05 * rate;
    }
    for (double& v : lambda) v = random.normal();
    problem.set_wrench(Wrench::Constant(random.normal()));
    problem.set_previous(previous.array(), 0.05);
    problem.set_branch(previous.array() + 0.3);
    problem.set_effort_scale(random.uniform(0.1, 2));
    const DerivativeReport report = check_derivatives(nlp, x, random.normal(), lambda);
    ASSERT_TRUE(report.finite);
    for (const DerivativeError& e : report.worst) {
      ADD_FAILURE() << vehicle.name << ": " << e.what << " of " << e.row << " by " << e.variable << ": " << e.analytic
                    << ", by differences " << e.difference;
    }
  }
}

TEST(WrenchAllocation, ObeysTheDerivativeLaw) {
  for (const bool hard : {false, true}) {
    for (const char* name : {"momav", "momav-bench", "fixed-tilt-hexa", "flat-hexa"}) obeys_the_derivative_law<6>(vehicle_with(name, hard));
    obeys_the_derivative_law<4>(vehicle_with("tilt-quad", hard));
  }
}

/// Two traces agree to 1e-8 up to the last step (a path of ten steps multiplies the rounding of two factorisations: 2e-9 was seen); at the end there is nothing left but rounding.
void expect_same_trace(const std::vector<Iteration>& fixed, const std::vector<Iteration>& sparse, std::size_t row) {
  ASSERT_EQ(fixed.size(), sparse.size()) << "row " << row;
  for (std::size_t k = 0; k + 1 < fixed.size(); ++k) {
    const auto expect_near = [&](double a, double b, double scale) {
      EXPECT_NEAR(a, b, 1e-8 * std::max({scale, std::abs(a), std::abs(b)})) << "row " << row << ", iteration " << k;
    };
    expect_near(fixed[k].objective, sparse[k].objective, 0);
    expect_near(fixed[k].primal, sparse[k].primal, 1e-2);
    expect_near(fixed[k].dual, sparse[k].dual, 1e-2);
    expect_near(fixed[k].mu, sparse[k].mu, 0);
    expect_near(fixed[k].alpha_primal, sparse[k].alpha_primal, 0);
    expect_near(fixed[k].alpha_dual, sparse[k].alpha_dual, 0);
    EXPECT_EQ(fixed[k].trials, sparse[k].trials) << "row " << row << ", iteration " << k;
  }
}

TEST(NewtonKkt, ArmBlocksAndTheSparseKindGiveTheSameIterates) {
  for (const char* name : {"momav", "momav-bench", "tilt-quad"}) {
    const Vehicle vehicle = vehicle_with(name, false);
    std::vector<Iteration> trace;
    Options options;
    options.on_iteration = [&trace](const Iteration& at) {
      trace.push_back(at);
      return true;
    };
    const auto row = make_allocation_row(vehicle, options);
    const std::vector<RandomRow> rows = random_rows(vehicle, 50, 3);
    for (std::size_t k = 0; k < rows.size(); ++k) {
      row->set(rows[k].wrench, rows[k].previous, kSequenceStep);
      Point start(row->lifted().num_variables(), 6);
      start.x << rows[k].throttle, rows[k].angle;
      trace.clear();
      row->measure_fixed_size(start, 0);
      const std::vector<Iteration> fixed = std::move(trace);
      trace.clear();
      Options unscaled = options;  // as the path of fixed size
      unscaled.scaling = false;
      make_solver("newton-kkt", row->lifted(), unscaled)->solve(start);
      SCOPED_TRACE(name);
      expect_same_trace(fixed, trace, k);
    }
  }
}

TEST(TickAllocator, AllocatesNoMemory) {
  for (const char* name : {"momav", "momav-bench", "flat-hexa", "tilt-quad"}) {
    for (const bool hard : {true, false}) {
      const Vehicle vehicle = vehicle_with(name, hard);
      const auto allocator = make_allocator(vehicle, "newton-kkt", {});
      const std::vector<Wrench> wrenches = with_noise(hover_sweep(vehicle, 500), 0.5, 0.05, 1);
      const AllocationCounter counter;
      for (const Wrench& wrench : wrenches) allocator->allocate(wrench, kSequenceStep);
      EXPECT_EQ(counter.count(), 0) << name << (hard ? ", hard limits" : ", soft limits");
    }
  }
}

TEST(TickAllocator, TwoRunsAreEqualBitForBit) {
  const Vehicle vehicle = vehicle_with("momav-bench", true);
  const std::vector<Wrench> wrenches = random_walk(vehicle, 2000, 5);
  const AllocationRun one = run_newton(vehicle, wrenches), two = run_newton(vehicle, wrenches);
  for (std::size_t k = 0; k < one.rows.size(); ++k) {
    ASSERT_EQ(one.rows[k].throttle, two.rows[k].throttle);
    ASSERT_EQ(one.rows[k].angle, two.rows[k].angle);
    ASSERT_EQ(one.rows[k].iterations, two.rows[k].iterations);
    ASSERT_EQ(one.rows[k].residual, two.rows[k].residual);
  }
}

TEST(TickAllocator, AnglesGoOnBeyondAWholeTurn) {
  const Vehicle vehicle = vehicle_with("momav", true);
  std::vector<Wrench> spin;
  const Eigen::Vector3d axis = vehicle.rotors[0].axis, across = vehicle.rotors[0].zero, normal = axis.cross(across);
  for (int k = 0; k < 2400; ++k) {  // three turns about the first arm in ten seconds
    const double turned = 6 * M_PI * k / 2400, weight = vehicle.mass * vehicle.gravity;
    Wrench wrench = Wrench::Zero();
    for (int i = 0; i < 3; ++i) wrench[i] = weight * (std::cos(turned) * across[i] + std::sin(turned) * normal[i]);
    spin.push_back(wrench);
  }
  const AllocationRun run = run_newton(vehicle, spin);
  EXPECT_EQ(run.fallback.size() + run.best_effort.size(), 0U);
  EXPECT_LE(run.fastest, kFullRate + 1e-9);
  EXPECT_NEAR(run.rows.back().angle[0] - run.rows.front().angle[0], 6 * M_PI, 0.2);
}

TEST(TickAllocator, AFlatVehicleGivesWhatItCan) {
  const Vehicle vehicle = vehicle_with("flat-hexa", true);
  const auto allocator = make_allocator(vehicle, "newton-kkt", {});
  for (int k = 0; k < 10; ++k) {
    const Allocation& row = allocator->allocate((Wrench() << 1, -2, 20, .1, -.1, .02).finished(), kSequenceStep);
    EXPECT_EQ(row.status, AllocationStatus::best_effort);
    EXPECT_NEAR(row.error[0], -1, 1e-3);
    EXPECT_NEAR(row.error[1], 2, 1e-3);
    EXPECT_LT(row.error.tail<4>().lpNorm<Eigen::Infinity>(), 1e-2);
  }
  EXPECT_EQ(allocator->allocate((Wrench() << 0, 0, 20, .1, -.1, .02).finished(), kSequenceStep).status, AllocationStatus::solved);
}

TEST(TickAllocator, AStuckServoStaysWhereItIs) {
  const Vehicle vehicle = vehicle_with("momav", true);
  const std::vector<Wrench> sweep = hover_sweep(vehicle, 4800);
  const auto allocator = make_allocator(vehicle, "newton-kkt", {});
  double stuck = 0;
  for (std::size_t k = 0; k < sweep.size(); ++k) {
    if (k == 100) {
      stuck = allocator->allocate(sweep[k], kSequenceStep).angle[3];
      allocator->stick_servo(3);
      continue;
    }
    const Allocation& row = allocator->allocate(sweep[k], 3 * kSequenceStep);
    ASSERT_NE(row.status, AllocationStatus::fallback) << "row " << k;
    if (k > 100) {
      ASSERT_EQ(row.angle[3], stuck) << "row " << k;
    }
  }
}

TEST(TickAllocator, BestEffortIsGoneAsSoonAsTheArmsHaveArrived) {
  for (const char* name : {"momav", "momav-bench"}) {
    const Vehicle vehicle = vehicle_with(name, true);
    const auto allocator = make_allocator(vehicle, "newton-kkt", {});
    const double weight = vehicle.mass * vehicle.gravity;
    const auto push = [&](double angle) {
      return (Wrench() << weight * std::sin(angle), 0, weight * std::cos(angle), 0, 0, 0).finished();
    };
    const Vector before = allocator->allocate(push(0), kSequenceStep).angle;
    Vector there = Vector::Zero(6), u = there;
    LinearAllocation(vehicle).solve(push(0.8), before, u, there);
    const double time_needed = (there - before).lpNorm<Eigen::Infinity>() / kFullRate;
    int late = 0;
    for (int k = 1; k <= 240; ++k) {
      const Allocation& row = allocator->allocate(push(0.8), kSequenceStep);
      ASSERT_NE(row.status, AllocationStatus::fallback) << name << " " << k;
      if (row.status == AllocationStatus::best_effort) late = k;
    }
    EXPECT_GT(late, 0) << name;
    EXPECT_LE(late * kSequenceStep, time_needed + 2 * kSequenceStep) << name;
  }
}

}  // namespace
}  // namespace tenon
