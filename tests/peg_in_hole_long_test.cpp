// The peg in its hole in 500 worlds of each setting: the horizon beside its baselines, on the delta, at 500 Hz. Each case prints its rows of the
// tables in peg_in_hole.md.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <numeric>
#include <optional>
#include <thread>

#include "tenon/apps/statistics.hpp"
#include "tenon/mpc/closed_loop.hpp"
#include "tenon/mpc/monte_carlo.hpp"
#include "tenon/mpc/task_controllers.hpp"
#include "tenon/problems/tasks.hpp"
#include "tenon/solvers/newton_kkt/make_newton_kkt.hpp"

namespace tenon::peg {
namespace {

constexpr int kWorlds = 500;

/// A closed loop's verdicts in all worlds, by their names.
using Verdicts = std::map<std::string, std::vector<double>>;

double success(const Verdicts& verdicts) {
  return mean(verdicts.at("success"));
}
double most(const Verdicts& verdicts, const std::string& name) {
  return percentile(verdicts.at(name), 0.95);
}
/// Of all worlds those in which it succeeded and nothing ever pushed harder than 15 N.
double gentle_success(const Verdicts& verdicts) {
  int count = 0;
  for (int k = 0; k < kWorlds; ++k) {
    const auto at = static_cast<std::size_t>(k);
    count += verdicts.at("success")[at] == 1 && verdicts.at("largest_force")[at] < 15;
  }
  return static_cast<double>(count) / kWorlds;
}

void print(const std::string& setting, const std::string& controller, const Verdicts& verdicts) {
  std::printf("| %s | %s | %.1f %% | %.2f | %.1f | %.1f | %.1f %% |\n", setting.c_str(), controller.c_str(), 100 * success(verdicts),
              most(verdicts, "time"), most(verdicts, "first_touch_peak"), most(verdicts, "sustained_force"), 100 * gentle_success(verdicts));
}

/// Worlds 1 to 500 on all cores.
Verdicts run_worlds(const std::string& scene, const std::string& controller, const std::vector<std::string>& overrides) {
  const auto make_experiment = [&] {
    ControlTask task = tenon::make_task(scene, overrides);
    std::unique_ptr<Controller> law = take_controller(task, controller, make_newton_kkt);
    return std::make_unique<ClosedLoopExperiment>(std::move(task.plant), std::move(law), task.duration);
  };
  const std::vector<std::string> names = make_experiment()->names();
  std::vector<std::uint64_t> seeds(kWorlds);
  std::iota(seeds.begin(), seeds.end(), 1);
  Verdicts verdicts;
  const auto add = [&](std::uint64_t, const Vector& row) {
    for (std::size_t c = 0; c < names.size(); ++c) verdicts[names[c]].push_back(row[static_cast<int>(c)]);
  };
  run_samples(make_experiment, seeds, static_cast<int>(std::max(1U, std::thread::hardware_concurrency())), {.on_row = add});
  return verdicts;
}

struct Setting {
  std::string name, scene, friction;
  double least_success;
};

void PrintTo(const Setting& setting, std::ostream* out) {
  *out << setting.scene << ", " << setting.friction;
}

const Setting kSettings[] = {{"First", "peg-in-hole", "friction=0.2", 0.995},
                             {"FirstWithoutFriction", "peg-in-hole", "friction=0", 0.995},
                             {"Tight", "peg-in-hole-tight", "friction=0.2", 0.98},
                             {"TightWithoutFriction", "peg-in-hole-tight", "friction=0", 0.98}};

void expect_within_limits(const Verdicts& verdicts, double least_success) {
  EXPECT_GE(success(verdicts), least_success);
  EXPECT_LE(most(verdicts, "time"), 2);
  EXPECT_LE(most(verdicts, "sustained_force"), 8);
  EXPECT_LE(most(verdicts, "first_touch_peak"), 15);
}

class PegLong : public testing::TestWithParam<Setting> {};

INSTANTIATE_TEST_SUITE_P(Settings, PegLong, testing::ValuesIn(kSettings), [](const auto& p) { return p.param.name; });

TEST_P(PegLong, TheHorizonIsWithinItsLimitsAndNoBaselineIsSurerOrAsGoodInAll) {
  const auto& [name, scene, friction, least_success] = GetParam();
  const Verdicts horizon = run_worlds(scene, "mpc", {friction});
  print(name, "mpc", horizon);
  expect_within_limits(horizon, least_success);
  for (const std::string& baseline : controller_names(tenon::make_task(scene))) {
    if (baseline == "mpc") continue;
    SCOPED_TRACE(baseline);
    const Verdicts other = run_worlds(scene, baseline, {friction});
    print(name, baseline, other);
    EXPECT_GE(success(horizon), success(other));
    EXPECT_TRUE(most(horizon, "time") < most(other, "time") || most(horizon, "sustained_force") < most(other, "sustained_force"));
  }
}

TEST_P(PegLong, TheDeltasDynamicsCostAtMostTwoPoints) {
  const auto& [name, scene, friction, least_success] = GetParam();
  const Verdicts planar = run_worlds(scene, "mpc", {friction}), delta = run_worlds(scene, "mpc", {friction, "plant.robot=\"delta\""});
  print(name, "mpc on the delta", delta);
  expect_within_limits(delta, success(planar) - 0.02);
}

TEST_P(PegLong, FiveHundredHertzServeAsWellAsFifty) {
  const auto& [name, scene, friction, least_success] = GetParam();
  const Verdicts fast = run_worlds(scene, "mpc", {friction, "rate=500"});
  print(name, "mpc at 500 Hz", fast);
  expect_within_limits(fast, least_success);
}

// What a prototype measured in 200 worlds of the first setting: the share of successes, and of those below 15 N. Without friction the peg falls
// harder off the flat here than there, so that more of what gives way exceeds 15 N: peg_in_hole.md, section 5.
TEST(PegBaselinesLong, SucceedWithinFivePointsOfAPrototypes) {
  struct Shares {
    const char *friction, *controller;
    double success;
    std::optional<double> gentle;
  };
  for (const Shares& prototype : {Shares{"friction=0.2", "straight", 0.815, 0.815},
                                  {"friction=0.2", "soft", 1, 0.9},
                                  {"friction=0.2", "admittance", 0.875, 0.81},
                                  {"friction=0.2", "tilt", 1, 1},
                                  {"friction=0", "straight", 0.815, 0.815},
                                  {"friction=0", "soft", 1, std::nullopt},
                                  {"friction=0", "admittance", 1, std::nullopt},
                                  {"friction=0", "tilt", 1, 1}}) {
    SCOPED_TRACE(std::string(prototype.controller) + ", " + prototype.friction);
    const Verdicts verdicts = run_worlds("peg-in-hole", prototype.controller, {prototype.friction});
    EXPECT_NEAR(success(verdicts), prototype.success, 0.05);
    if (prototype.gentle) {
      EXPECT_NEAR(gentle_success(verdicts), *prototype.gentle, 0.05);
    }
  }
}

}  // namespace
}  // namespace tenon::peg
