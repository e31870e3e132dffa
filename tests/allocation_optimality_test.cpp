// The allocation's answers against Ipopt's: the objective where the wrench can be had, the weighted error where it cannot.
#include <gtest/gtest.h>

#include "tenon/core/as_nlp.hpp"
#include "tenon/problems/allocation/wrench_allocation.hpp"
#include "tenon/solvers/make_solver.hpp"
#include "tenon/tests/allocation_run.hpp"

namespace tenon {
namespace {

bool has_ipopt() {
  for (const SolverDescription& solver : list_solvers()) {
    if (solver.name == "ipopt") return solver.available;
  }
  return false;
}

/// Single ticks of the same allocator on two solvers. Where throttles lie below their soft limit the problem is not convex, and two solvers may
/// end in different minima of the same row: `elsewhere` rows at most.
void expect_objectives_of_ipopt(const Vehicle& vehicle, int rows, int elsewhere) {
  const auto ours = make_allocator(vehicle, "newton-kkt", {}), theirs = make_allocator(vehicle, "ipopt", {});
  std::vector<std::string> different;
  int fallbacks = 0, other_status = 0;
  for (const RandomRow& row : random_rows(vehicle, rows, 1)) {
    ours->reset(row.previous);
    theirs->reset(row.previous);
    const Allocation& a = ours->allocate(row.wrench, kSequenceStep);
    const Allocation& b = theirs->allocate(row.wrench, kSequenceStep);
    fallbacks += a.status == AllocationStatus::fallback;
    EXPECT_GE(a.iterations, 1);
    other_status += a.status != b.status;
    // where the error is minimised, the effort counts 1e-4 and so does its share of the tolerance: the barriers' ends are 8e-6 apart
    const double tolerance = a.status == AllocationStatus::best_effort ? 2e-5 : 1e-6;
    if (std::abs(a.objective - b.objective) > tolerance * b.objective) {
      different.push_back(std::to_string(a.objective) + " against " + std::to_string(b.objective));
    }
  }
  EXPECT_EQ(fallbacks, 0);
  // A wrench missed by a little more or less than 1e-8 is best_effort on one side alone; seen: 19 rows of 2000.
  EXPECT_LE(other_status, rows / 50);
  EXPECT_LE(std::ssize(different), elsewhere) << testing::PrintToString(different);
}

TEST(Allocation, WithSoftLimitsObjectivesAreThoseOfIpopt) {
  if (!has_ipopt()) GTEST_SKIP() << "Ipopt is not there";
  expect_objectives_of_ipopt(vehicle_with("momav-bench", false), 1000, 20);  // seen: 17, where one side let the rows give way
}

TEST(Allocation, WithHardLimitsObjectivesAreThoseOfIpopt) {
  if (!has_ipopt()) GTEST_SKIP() << "Ipopt is not there";
  expect_objectives_of_ipopt(vehicle_with("momav-bench", true), 1000, 8);  // seen: 5, the same
}

/// The least weighted error within the box of this tick, from several starts.
double least_error(const Vehicle& vehicle, const Wrench& wrench, const Vector* previous, int failed, const std::vector<Vector>& starts) {
  WrenchAllocation<6> problem(vehicle);
  problem.set_wrench(wrench);
  if (previous) problem.set_previous(previous->array(), kSequenceStep);
  if (failed >= 0) problem.fail_rotor(failed);
  problem.set_wrench_stiffness(1);
  problem.set_effort_scale(1e-9);
  const AsNlp<WrenchAllocation<6>> nlp(problem);
  WrenchAllocation<6>::Workspace at;
  double least = kInfinity<double>;
  for (const Vector& start : starts) {
    Point point(12, 6);
    point.x = start;
    make_solver("ipopt", nlp, {})->solve(point);
    const WrenchAllocation<6>::VectorN x = point.x;
    Wrench error;
    problem.prepare(x, at);
    problem.constraints(x, at, error);
    least = std::min(least, weighted_error(vehicle, error));
  }
  return least;
}

/// Of the best-effort rows every so many. Within the box the error is not convex: of 15,864 best-effort rows at random the same solver from
/// another start ends in another minimum on 33, better on half of them. So one row in fifty may be missed.
void expect_errors_are_least(const Vehicle& vehicle, const AllocationRun& run, int failed, std::size_t samples) {
  const std::size_t stride = std::max<std::size_t>(1, run.best_effort.size() / samples);
  const LinearAllocation linear(vehicle);
  std::string missed;
  int misses = 0, checked = 0;
  for (std::size_t s = 0; s < run.best_effort.size(); s += stride, ++checked) {
    const std::size_t k = run.best_effort[s];
    const Allocation& row = run.rows[k];
    const Vector* previous = k > 0 ? &run.rows[k - 1].angle : nullptr;
    Vector own(12), u(6), a = previous ? *previous : Vector::Zero(6);
    linear.solve(run.asked[k], a, u, a);
    own << row.throttle, row.angle;
    const double ours = weighted_error(vehicle, row.error);
    const double theirs = least_error(vehicle, run.asked[k], previous, failed, {own, (Vector(12) << u, a).finished()});
    if (ours > 1.01 * theirs + 1e-6) {
      ++misses;
      missed += "row " + std::to_string(k) + ": weighted error " + std::to_string(ours) + ", Ipopt " + std::to_string(theirs) + "\n";
    }
  }
  EXPECT_LE(misses, checked / 50) << missed << "of " << checked << " of " << run.best_effort.size() << " best-effort rows";
}

TEST(BestEffort, NoSmallerErrorIsToBeHadUnderNoise) {
  if (!has_ipopt()) GTEST_SKIP() << "Ipopt is not there";
  for (const char* name : {"momav", "momav-bench"}) {
    SCOPED_TRACE(name);
    const Vehicle vehicle = vehicle_with(name, true);
    expect_errors_are_least(vehicle, run_newton(vehicle, with_noise(hover_sweep(vehicle), 0.5, 0.05, 1)), -1, 100);
  }
}

TEST(BestEffort, NoSmallerErrorIsToBeHadOnARandomWalk) {
  if (!has_ipopt()) GTEST_SKIP() << "Ipopt is not there";
  const Vehicle vehicle = vehicle_with("momav", true);
  expect_errors_are_least(vehicle, run_newton(vehicle, random_walk(vehicle, 14400, 1)), -1, 50);
}

TEST(BestEffort, NoSmallerErrorIsToBeHadWithoutARotor) {
  if (!has_ipopt()) GTEST_SKIP() << "Ipopt is not there";
  const Vehicle vehicle = vehicle_with("momav", true);
  for (int failed = 0; failed < 6; failed += 2) {
    SCOPED_TRACE(failed);
    const auto allocator = make_allocator(vehicle, "newton-kkt", {});
    allocator->fail_rotor(failed);
    expect_errors_are_least(vehicle, run_allocator(*allocator, hover_sweep(vehicle)), failed, 40);
  }
}

}  // namespace
}  // namespace tenon
