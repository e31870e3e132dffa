// tenon mpc, as a script sees it.
#include <gtest/gtest.h>

#include "tenon/core/csv.hpp"
#include "tenon/tests/run_tenon.hpp"

namespace tenon {
namespace {

class MpcVerb : public testing::Test {
 protected:
  Ended run(const std::string& arguments) { return run_tenon(folder_, "mpc " + arguments); }

  void expect_bad_input(const std::string& arguments, const std::string& line) {
    tenon::expect_bad_input(folder_, "mpc " + arguments, line);
  }

  ScratchFolder folder_;
};

TEST_F(MpcVerb, SaysHowTheRunWentAsJson) {
  const Ended ended = run("delta-touch-down --seed 3 --json --quiet");
  EXPECT_EQ(ended.code, 0) << ended.err;
  for (const char* key : {"\"schema\": 1", "\"steps\": 200", "\"deadline_misses\":", "\"step_time\": {", "\"median\":", "\"p99\":", "\"max\":",
                          "\"verdicts\": {", "\"success\": 1", "\"baselines\": [", "\"tracking\"", "\"pair\""}) {
    EXPECT_NE(ended.out.find(key), std::string::npos) << key << ended.out;
  }
}

TEST_F(MpcVerb, TheRecordIsTheSameEveryTimeButForTheClock) {
  CsvTable runs[2];
  for (CsvTable& table : runs) {
    const Ended ended = run("delta-touch-down --seed 3 --set duration=0.5 --output run.csv --quiet");
    EXPECT_EQ(ended.code, 0) << ended.err;
    table = read_csv(folder_.path("run.csv"));
  }
  EXPECT_EQ(runs[0].rows(), 50);
  ASSERT_EQ(runs[0].names.back(), "step_time");
  for (std::size_t k = 0; k + 1 < runs[0].names.size(); ++k) EXPECT_EQ(runs[0].columns[k], runs[1].columns[k]) << runs[0].names[k];
  EXPECT_TRUE(folder_.has("run.scene.json"));
}

TEST_F(MpcVerb, AnIterationATickIsARealTimeIteration) {
  const Ended ended = run("cart-pole-soft-walls --max-iterations 1 --output run.csv --json --quiet");
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_NE(ended.out.find("\"success\": 1"), std::string::npos) << ended.out;
  const CsvTable table = read_csv(folder_.path("run.csv"));
  for (std::size_t k = 1; k < table["iterations"].size(); ++k) {
    if (table["fallback"][k - 1] != 0) continue;  // the one after starts afresh
    EXPECT_LE(table["iterations"][k], 1) << "row " << k;
  }
}

TEST_F(MpcVerb, TheScenesHaveNames) {
  const Ended ended = run_tenon(folder_, "list scenes");
  EXPECT_NE(ended.out.find("cart-pole-soft-walls"), std::string::npos);
  EXPECT_NE(ended.out.find("delta-touch-down"), std::string::npos);
}

TEST_F(MpcVerb, BadInputIsOneLineAndLeavesNothing) {
  expect_bad_input("delta-touch", "unknown task 'delta-touch', the nearest is 'delta-touch-down'");
  expect_bad_input("delta-touch-down --set masss=1", "--set parameters.masss=1: unknown key 'masss'");
  expect_bad_input("delta-touch-down --time-limit -1", "");
  expect_bad_input("missing.toml", "missing.toml");
  folder_.write("other.toml", "task = \"touch-dwn\"\n");
  expect_bad_input("other.toml", "other.toml:1:8: unknown task 'touch-dwn', the nearest is 'touch-down'");
  expect_bad_input("delta-touch-down --output missing/run.csv", "missing/run.csv");
  EXPECT_FALSE(folder_.has("run.csv"));
}

}  // namespace
}  // namespace tenon
