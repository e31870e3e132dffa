// tenon plan, as a script sees it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tenon/core/csv.hpp"
#include "tenon/tests/run_tenon.hpp"

namespace tenon {
namespace {

class PlanVerb : public testing::Test {
 protected:
  Ended run(const std::string& arguments) { return run_tenon(folder_, "plan " + arguments); }

  void expect_bad_input(const std::string& arguments, const std::string& line) {
    tenon::expect_bad_input(folder_, "plan " + arguments + " --output out.csv", line);
  }

  ScratchFolder folder_;
};

TEST_F(PlanVerb, APlanIsARecordAndAReport) {
  const Ended ended = run("bouncing-ball-catch --report plan.html");
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_NE(ended.out.find("bouncing-ball-catch: solved by "), std::string::npos) << ended.out;
  EXPECT_NE(ended.out.find("bounce: 0.451524 to "), std::string::npos) << ended.out;
  const CsvTable table =
      read_csv(folder_.path("plan.csv"), {{"t", "x1", "y1", "vy1", "lambda_cup_y", "cup_ax", "gap_floor", "mode_cup"}, {}});
  EXPECT_EQ(table["t"].front(), 0);
  EXPECT_NEAR(table["x1"].back(), 0.6, 1e-8);
  EXPECT_NEAR(table["y1"].back(), 0.3, 1e-8);
  EXPECT_EQ(table["mode_cup"].back(), 2);
  EXPECT_TRUE(folder_.has("plan.html") && folder_.has("plan.scene.json") && folder_.has("plan.jsonl"));
}

TEST_F(PlanVerb, TheResultIsOneObjectWithItsMesh) {
  const Ended ended = run("pendulum --json --set force_weight=0.05 --set horizon.points=2 --set horizon.tolerance=1e-5");
  EXPECT_EQ(ended.code, 0) << ended.err;
  for (const char* key : {"\"schema\": 1", "\"status\": \"solved\"", "\"points\": 2", "\"refinements\": ", "\"end_error\": {"}) {
    EXPECT_NE(ended.out.find(key), std::string::npos) << key << ended.out;
  }
}

// What a horizon looks ahead to for some tenths of a second is planned whole here: from the start to the end, in SI.
TEST_F(PlanVerb, AnInsertionIsPlannedIntoTheHoleOfTheScene) {
  const Ended ended = run("peg-in-hole --set offset_x=0.0014 --set offset_theta=0.03 --report plan.html");
  EXPECT_EQ(ended.code, 0) << ended.err;
  const CsvTable table = read_csv(folder_.path("plan.csv"), {{"t", "x", "z", "theta", "hole_x", "depth", "energy", "lambda_corner_left",
                                                              "gap_corner_left", "mode_corner_left", "reference_x"}, {}});
  EXPECT_EQ(table["x"].front(), 0);
  EXPECT_NEAR(table["z"].front(), 5e-3, 1e-12);
  EXPECT_EQ(table["hole_x"].back(), 0.0014);
  EXPECT_NEAR(table["theta"].back(), 0.03, 1e-3);
  EXPECT_GE(table["depth"].back(), 0.0198) << "of 20 mm";
  for (std::size_t row = 0; row < table["t"].size(); ++row) {
    EXPECT_GE(table["gap_corner_left"][row], -1e-8);
    EXPECT_LE(table["gap_corner_left"][row] * table["lambda_corner_left"][row], 1.01e-5);  // N m: [horizon] complementarity
  }
}

TEST_F(PlanVerb, ATouchDownAndTheSoftWallsArePlannedToTheirEnds) {
  EXPECT_EQ(run("delta-touch-down --output down.csv").code, 0);
  const CsvTable down = read_csv(folder_.path("down.csv"), {{"z", "v", "lambda_plane", "gap_plane", "mode_plane"}, {}});
  EXPECT_NEAR(down["z"].front(), 0.36, 1e-12);
  EXPECT_NEAR(down["gap_plane"].back(), 0, 1e-5);
  EXPECT_NEAR(down["lambda_plane"].back(), 5, 0.01);
  const auto touch = static_cast<std::size_t>(std::ranges::find(down["mode_plane"], 2) - down["mode_plane"].begin());
  EXPECT_LE(down["v"][touch], 0.015);
  EXPECT_EQ(run("cart-pole-soft-walls --output walls.csv").code, 0);
  const CsvTable walls = read_csv(folder_.path("walls.csv"), {{"x", "theta", "v", "omega", "lambda_right", "mode_right"}, {}});
  EXPECT_NEAR(walls["theta"].front(), -0.5, 1e-12);
  for (const char* state : {"x", "theta", "v", "omega"}) EXPECT_LE(std::abs(walls[state].back()), 1e-2) << state;
}

TEST_F(PlanVerb, WhatCannotBeMetIsNamedWithItsStageAndTime) {
  const Ended ended = run("pendulum-cartesian --set horizon.duration=0.3 --set horizon.intervals=6 --max-iterations 300 --output out.csv");
  EXPECT_EQ(ended.code, 1);
  EXPECT_NE(ended.err.find("no plan: "), std::string::npos) << ended.err;
  EXPECT_NE(ended.err.find(" cannot be met in stage "), std::string::npos) << ended.err;
  EXPECT_NE(ended.err.find("held back by the bounds of "), std::string::npos) << ended.err;
  EXPECT_FALSE(folder_.has("out.csv"));
  EXPECT_TRUE(folder_.has("out.csv.partial"));
}

TEST_F(PlanVerb, BadInputIsOneLine) {
  expect_bad_input("cart-pol", "unknown scene to plan 'cart-pol', the nearest is 'cart-pole'");
  expect_bad_input("cart-pole --set goul=2", "--set parameters.goul=2: unknown key 'goul' in parameters");
  expect_bad_input("cart-pole --set pole_mass=-1", "cart-pole: pole_mass is -1 (expected more than 0)");
  expect_bad_input("cart-pole --set horizon.points=4", "--set horizon.points=4: points is 4 (expected 1 to 3)");
  expect_bad_input("push-and-slide --set contact=fases", "--set contact=fases: unknown contact 'fases', the nearest is 'phases'");
  expect_bad_input("cart-pole --solver none", "unknown solver");
  folder_.write("scene.toml", "model = \"pendulum\"\n[parameters]\nlength = nan\n");
  expect_bad_input("scene.toml", "scene.toml:3:");
}

TEST_F(PlanVerb, AFileIsASceneToo) {
  folder_.write("scene.toml", "model = \"pendulum\"\n[parameters]\nlength = 0.5\n[horizon]\ntolerance = 1e-3\n");
  const Ended ended = run("scene.toml --output out.csv");
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_TRUE(ended.out.starts_with("scene: solved")) << ended.out;
}

TEST_F(PlanVerb, WhatIsPlannedIsAlsoAProblem) {
  EXPECT_EQ(run_tenon(folder_, "check pendulum/collocation").code, 0);
  const Ended compared = run_tenon(folder_, "compare pendulum-cartesian --solvers newton-kkt");
  EXPECT_EQ(compared.code, 0) << compared.err;
  EXPECT_NE(compared.out.find("18.6"), std::string::npos) << compared.out;
}

}  // namespace
}  // namespace tenon
