// tenon fly, as a script sees it.
#include <gtest/gtest.h>

#include "tenon/core/csv.hpp"
#include "tenon/tests/run_tenon.hpp"

namespace tenon {
namespace {

class FlyVerb : public testing::Test {
 protected:
  Ended run(const std::string& arguments) { return run_tenon(folder_, "fly " + arguments); }

  void expect_bad_input(const std::string& arguments, const std::string& line) {
    tenon::expect_bad_input(folder_, "fly " + arguments + " --output out.csv", line);
  }

  ScratchFolder folder_;
};

TEST_F(FlyVerb, TheMissionsHaveNames) {
  const Ended ended = run_tenon(folder_, "list missions");
  EXPECT_EQ(ended.code, 0);
  for (const char* name : {"hover", "position-sweep", "orientation-sweep", "tumble", "step", "figure-eight", "singular-crossing",
                           "rotor-failure", "servo-failure", "overload"}) {
    EXPECT_NE(ended.out.find(std::string("\n  ") + name + " "), std::string::npos) << name;
  }
}

TEST_F(FlyVerb, RecordsTheFlightItsEventsAndItsPicture) {
  const Ended ended = run("rotor-failure --set simulation.duration=3 --output out.csv --events events.csv");
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_NE(ended.out.find("position error  mean"), std::string::npos) << ended.out;
  const CsvTable record = read_csv(folder_.path("out.csv"), {{}, {}, true});
  EXPECT_EQ(record.rows(), 3 * 60 + 1);
  for (const char* name : {"t", "x", "qw", "vx", "omegax", "u6", "a6", "Mz", "x_ref", "qw_ref", "position_error", "angle_error", "Fx_asked",
                           "Mz_error", "u6_command", "a6_command", "a6_rate", "wind_x", "status"}) {
    EXPECT_TRUE(record.has(name)) << name;
  }
  EXPECT_NE(folder_.read("events.csv").find(",rotor 3,working,failed\n"), std::string::npos) << folder_.read("events.csv");
  EXPECT_NE(folder_.read("out.scene.json").find("\"reference\""), std::string::npos);
}

TEST_F(FlyVerb, ThePublishedStatisticsStandInTheJson) {
  const Ended ended = run("position-sweep --set simulation.duration=2 --json");
  EXPECT_EQ(ended.code, 0) << ended.err;
  for (const char* key : {"\"schema\": 1", "\"status\": \"reached\"", "\"position_error\": {\n    \"mean\"",
                          "\"angle_error\": {\n    \"mean\"", "\"sd\"", "\"max\"", "\"limits_hit\": 0", "\"allocation_failures\": 0"}) {
    EXPECT_NE(ended.out.find(key), std::string::npos) << key << "\n" << ended.out;
  }
}

TEST_F(FlyVerb, ASeedGivesTheSameRecordAgain) {
  for (const char* arguments : {"--seed 3 --output a.csv", "--seed 3 --output b.csv", "--seed 4 --output c.csv"}) {
    EXPECT_EQ(run(std::string("hover --set simulation.duration=0.5 ") + arguments).code, 0);
  }
  EXPECT_EQ(folder_.read("a.csv"), folder_.read("b.csv"));
  EXPECT_NE(folder_.read("a.csv"), folder_.read("c.csv"));
}

TEST_F(FlyVerb, ALostFlightLeavesItsRecordUpToThere) {
  const Ended ended = run("overload --output out.csv --events events.csv --json");
  EXPECT_EQ(ended.code, 1);
  EXPECT_TRUE(is_one_line(ended.err, "tenon: overload: t = 1.")) << ended.err;
  EXPECT_NE(ended.err.find("hovering there takes 68.6 N, and the rotors give 63.7 N; "), std::string::npos) << ended.err;
  EXPECT_NE(ended.out.find("\"status\": \"lost\""), std::string::npos) << ended.out;
  EXPECT_FALSE(folder_.has("out.csv"));
  EXPECT_GT(read_csv(folder_.path("out.csv.partial"), {{"t", "z"}, {}}).rows(), 50);
}

TEST_F(FlyVerb, GainsThatDestabiliseAreNamedBeforeTheFlightAndWhereItIsLost) {
  const Ended ended = run("position-sweep --set controller.force=[100,200,1] --output out.csv");
  EXPECT_EQ(ended.code, 1);
  const std::string fault = "with a lag of 0.03 s the force gains 100, 200, 1 make an unstable loop";
  EXPECT_TRUE(ended.err.starts_with("tenon: position-sweep: " + fault + "\n")) << ended.err;
  EXPECT_NE(ended.err.find("m from its reference; " + fault), std::string::npos) << ended.err;
  EXPECT_TRUE(folder_.has("out.csv.partial"));
}

TEST_F(FlyVerb, TakesOtherAllocators) {
  const Ended ended = run("hover --solver pseudo-inverse --set simulation.duration=1 --json --quiet");
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_NE(ended.out.find("\"solver\": \"pseudo-inverse\""), std::string::npos);
}

TEST_F(FlyVerb, BadInputEndsWithOneLine) {
  expect_bad_input("positon-sweep", "unknown mission 'positon-sweep', the nearest is 'position-sweep'");
  expect_bad_input("hover --solver ipot", "unknown solver 'ipot', the nearest is 'ipopt'");
  expect_bad_input("hover --set vehicle.mass=0", "--set vehicle.mass=0: mass is 0 (expected more than 0)");
  expect_bad_input("hover --set controler.rate=1", "--set controler.rate=1: unknown key 'controler'");
  folder_.write("gaps.toml", "[reference]\nkind = \"legs\"\n[[reference.leg]]\nposition = [1, 0, 0]\n");
  expect_bad_input("gaps.toml", "gaps.toml:3:1: ");
}

}  // namespace
}  // namespace tenon
