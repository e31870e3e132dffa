// Whole sequences through Newton-KKT: hover sweeps, noise, random walks, cold starts, failures. What is asked of every row: a command within
// the limits; of a row whose wrench can be had: that wrench.
#include <gtest/gtest.h>

#include <filesystem>
#include <tuple>

#include "tenon/apps/statistics.hpp"
#include "tenon/problems/allocation/wrench_log.hpp"
#include "tenon/tests/allocation_run.hpp"

namespace tenon {
namespace {

constexpr double kFullRate = 2 * M_PI;
const std::filesystem::path kSourceDir = TENON_SOURCE_DIR;

std::vector<Wrench> wrenches_of(const std::filesystem::path& log) {
  std::vector<Wrench> wrenches;
  for (const WrenchRow& row : read_wrench_log(log.string())) wrenches.push_back(row.wrench);
  return wrenches;
}

void expect_limits_kept(const AllocationRun& run) {
  EXPECT_TRUE(run.fallback.empty()) << run.fallback.size() << " rows, the first is " << run.fallback.front();
  EXPECT_GE(run.throttle_lowest, 0);
  EXPECT_LE(run.throttle_highest, 1);
  EXPECT_LE(run.fastest, kFullRate + 1e-9);
}

void expect_every_wrench_met(const AllocationRun& run) {
  expect_limits_kept(run);
  EXPECT_TRUE(run.best_effort.empty()) << run.best_effort.size() << " rows, the first is " << run.best_effort.front();
  EXPECT_LE(run.worst_error, 1e-6);
}

/// Rows within half a second after one in which an arm turned at its limit, or before one: there the limit explains an effort beyond the best.
std::vector<bool> hurried(const AllocationRun& run) {
  constexpr std::ptrdiff_t kReach = 120;
  std::vector<bool> out(run.rows.size(), false);
  for (std::size_t k = 1; k < run.rows.size(); ++k) {
    const double rate = (run.rows[k].angle - run.rows[k - 1].angle).lpNorm<Eigen::Infinity>() / kSequenceStep;
    if (rate < 0.99 * kFullRate) continue;
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(k);
    std::fill(out.begin() + std::max<std::ptrdiff_t>(0, at - kReach), out.begin() + std::min(std::ssize(out), at + kReach), true);
  }
  return out;
}

/// The reference turns half as fast (0.4 rad/s in the mean, ours 0.9) and meets a singular direction four times, ours twelve times.
void expect_effort_near_the_bound(const Vehicle& vehicle, const AllocationRun& run, bool reference) {
  const std::vector<double> over = run.over_bound(vehicle);
  EXPECT_LE(mean(over), reference ? 0.003 : 0.0035);
  EXPECT_LE(percentile(over, 0.99), reference ? 0.06 : 0.07);
  const std::vector<bool> excused = hurried(run);
  for (std::size_t k = 0; k < over.size(); ++k) {
    if (!excused[k]) {
      ASSERT_LE(over[k], 0.02) << "row " << k;
    }
  }
}

class HoverSweep : public testing::TestWithParam<std::string> {};

TEST_P(HoverSweep, EveryWrenchIsMet) {
  const std::filesystem::path log = kSourceDir / GetParam();
  if (!std::filesystem::exists(log)) GTEST_SKIP() << log << " is not there";
  for (const char* name : {"momav", "momav-bench"}) {
    SCOPED_TRACE(name);
    const Vehicle vehicle = vehicle_with(name, true);
    const AllocationRun run = run_newton(vehicle, wrenches_of(log));
    EXPECT_EQ(run.rows.size(), 14400U);
    expect_every_wrench_met(run);
    if (LinearAllocation(vehicle).has_linear_thrust()) expect_effort_near_the_bound(vehicle, run, GetParam().starts_with(".."));
  }
}

TEST_P(HoverSweep, WithSoftLimitsEveryWrenchIsMet) {
  const std::filesystem::path log = kSourceDir / GetParam();
  if (!std::filesystem::exists(log)) GTEST_SKIP() << log << " is not there";
  for (const char* name : {"momav", "momav-bench"}) {
    const AllocationRun run = run_newton(vehicle_with(name, false), wrenches_of(log));
    EXPECT_TRUE(run.fallback.empty() && run.best_effort.empty()) << name;
    EXPECT_LE(run.worst_error, 1e-6) << name;
  }
}

TEST_P(HoverSweep, NoiseCausesNoFailure) {
  const std::filesystem::path log = kSourceDir / GetParam();
  if (!std::filesystem::exists(log)) GTEST_SKIP() << log << " is not there";
  for (const char* name : {"momav", "momav-bench"}) {
    SCOPED_TRACE(name);
    const std::vector<Wrench> noisy = with_noise(wrenches_of(log), 0.5, 0.05, 11);
    expect_limits_kept(run_newton(vehicle_with(name, true), noisy));
    const AllocationRun soft = run_newton(vehicle_with(name, false), noisy);
    EXPECT_TRUE(soft.fallback.empty()) << soft.fallback.size() << " rows, the first is " << soft.fallback.front();
    EXPECT_TRUE(soft.best_effort.empty()) << soft.best_effort.size() << " rows, the first is " << soft.best_effort.front();
  }
}

INSTANTIATE_TEST_SUITE_P(Logs, HoverSweep,
                         testing::Values("problems/allocation/hover_sweep.csv", "../shared/reference/allocation_hover_sweep.csv"),
                         [](const auto& log) { return log.index == 0 ? "OurOwn" : "Reference"; });

TEST(RandomWalk, NoFailureAndLimitsKept) {
  for (const char* name : {"momav", "momav-bench", "tilt-quad", "fixed-tilt-hexa", "flat-hexa"}) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      SCOPED_TRACE(name);
      const Vehicle vehicle = vehicle_with(name, true);
      const AllocationRun run = run_newton(vehicle, random_walk(vehicle, 4800, seed));
      expect_limits_kept(run);
    }
  }
}

TEST(ColdStart, EveryWrenchIsMet) {
  for (const char* name : {"momav", "momav-bench"}) {
    for (const bool hard : {true, false}) {
      SCOPED_TRACE(std::string(name) + (hard ? ", hard limits" : ", soft limits"));
      const Vehicle vehicle = vehicle_with(name, hard);
      std::vector<Wrench> wrenches;
      for (const RandomRow& row : random_rows(vehicle, 10000, 21)) wrenches.push_back(row.wrench);
      const AllocationRun run = run_newton(vehicle, wrenches, true);
      EXPECT_TRUE(run.fallback.empty()) << run.fallback.size() << " rows, the first is " << run.fallback.front();
      EXPECT_TRUE(run.best_effort.empty()) << run.best_effort.size() << " rows, the first is " << run.best_effort.front();
      if (hard) {
        EXPECT_LE(run.worst_error, 1e-6);
      }
    }
  }
}

TEST(FailedRotor, TheOthersGoOn) {
  for (const char* name : {"momav", "momav-bench"}) {
    const Vehicle vehicle = vehicle_with(name, true);
    const std::vector<Wrench> sweep = wrenches_of(kSourceDir / "problems/allocation/hover_sweep.csv");
    for (int failed = 0; failed < 6; ++failed) {
      SCOPED_TRACE(std::string(name) + ", rotor " + std::to_string(failed + 1));
      const auto allocator = make_allocator(vehicle, "newton-kkt", {});
      allocator->fail_rotor(failed);
      const AllocationRun run = run_allocator(*allocator, sweep);
      expect_limits_kept(run);
      for (const Allocation& row : run.rows) ASSERT_EQ(row.throttle[failed], 0);
      RecordProperty("best_effort_" + std::to_string(failed), static_cast<int>(run.best_effort.size()));
    }
  }
}

}  // namespace
}  // namespace tenon
