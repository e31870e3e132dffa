// tenon estimate and tenon sweep --margins, as a script sees them.
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tenon/apps/json.hpp"
#include "tenon/core/csv.hpp"
#include "tenon/tests/run_tenon.hpp"

namespace tenon {
namespace {

class EstimateVerb : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new ScratchFolder;
    ASSERT_EQ(run_tenon(*folder_, "mpc peg-in-hole --seed 3 --output run.csv --quiet").code, 0);
  }
  static void TearDownTestSuite() { delete folder_; }

  static Ended run(const std::string& arguments) { return run_tenon(*folder_, arguments); }
  static Json estimate(const std::string& record) {
    const Ended ended = run("estimate peg-in-hole --measurements " + record + " --json");
    EXPECT_EQ(ended.code, 0) << ended.err;
    return Json::parse(ended.out, "stdout");
  }
  void expect_bad_input(const std::string& record, const std::string& line) {
    tenon::expect_bad_input(*folder_, "estimate peg-in-hole --measurements " + record + " --output out.csv", line);
  }

  static ScratchFolder* folder_;
};
ScratchFolder* EstimateVerb::folder_ = nullptr;

// The same estimator, the same measurements: what the controller believed when it ended.
TEST_F(EstimateVerb, BelievesWhatTheControllerDid) {
  const CsvTable record = read_csv(folder_->path("run.csv"), {{}, {}, true});
  const Json result = estimate("run.csv");
  EXPECT_EQ(result.at("rows").number(), record.rows());
  for (const Json& e : result.at("estimates").elements()) {
    const std::string name = e.at("name").as_text();
    EXPECT_NEAR(e.at("mean").number(), record[name].back(), 1e-12) << name;
    EXPECT_NEAR(e.at("sd").number(), std::sqrt(record["cov_" + name + "_" + name].back()), 1e-12) << name;
  }
}

// Bitwise: the truth's columns are not looked at.
TEST_F(EstimateVerb, DoesNotReadTheTruth) {
  const std::string text = folder_->read("run.csv"), header = text.substr(0, text.find('\n'));
  std::string without;
  const CsvTable record = read_csv(folder_->path("run.csv"), {{}, {}, true});
  std::vector<std::string> kept;
  for (const std::string& name : record.names) {
    if (name == "t" || name.starts_with("measured_") || name.starts_with("reference_") || name.starts_with("stiffness_")) kept.push_back(name);
  }
  {
    CsvWriter csv(folder_->path("blind.csv"), kept);
    for (std::size_t k = 0; k < record.lines.size(); ++k) {
      for (const std::string& name : kept) csv << record[name][k];
      csv.end_row();
    }
    csv.finish();
  }
  EXPECT_EQ(run("estimate peg-in-hole --measurements run.csv --output one.csv").code, 0);
  EXPECT_EQ(run("estimate peg-in-hole --measurements blind.csv --output two.csv").code, 0);
  EXPECT_EQ(folder_->read("one.csv"), folder_->read("two.csv"));
}

TEST_F(EstimateVerb, ItsReportHasTheBeliefOfEveryRowAndNoTruth) {
  const Ended ended = run("estimate peg-in-hole --measurements run.csv --report believed.html");
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_TRUE(folder_->has("believed.html"));
  const CsvTable record = read_csv(folder_->path("run.csv"), {{}, {}, true}), believed = read_csv(folder_->path("believed.csv"));
  const std::string covariance = "cov_estimate_hole_x_estimate_hole_theta";
  EXPECT_EQ(believed[covariance], record[covariance]);
  const Json scenery = Json::parse(folder_->read("believed.scene.json"), "believed.scene.json");
  EXPECT_EQ(scenery.at("bodies").elements().size(), 0u);
  ASSERT_EQ(scenery.at("estimates").elements().size(), 1u);
  EXPECT_EQ(scenery.at("estimates").elements()[0].at("across").at("mean").as_text(), "estimate_hole_x");
  EXPECT_FALSE(scenery.at("estimates").elements()[0].at("across").has("truth"));
}

TEST_F(EstimateVerb, SaysWhatARecordSaysNothingAbout) {
  const std::string text = folder_->read("run.csv");
  std::size_t end = 0;
  for (int line = 0; line < 4; ++line) end = text.find('\n', end) + 1;
  folder_->write("air.csv", text.substr(0, end));  // nothing has been touched yet
  const Json result = estimate("air.csv");
  EXPECT_FALSE(result.at("not_observed").elements().empty());
  EXPECT_TRUE(estimate("run.csv").at("not_observed").elements().size() < result.at("not_observed").elements().size());
}

// A moving horizon from the command line: an experiment that moves nothing, and one whose truth has been scrambled.
TEST_F(EstimateVerb, SaysThatARestingFingerLearnsNothingOfTheBlock) {
  ASSERT_EQ(run("mpc pushed-block --set motion=rest --set duration=0.3 --output rest.csv --quiet").code, 0);
  const Ended ended = run("estimate pushed-block --measurements rest.csv --json");
  ASSERT_EQ(ended.code, 0) << ended.err;
  std::vector<std::string> unobserved;
  const Json result = Json::parse(ended.out, "stdout");
  for (const Json& name : result.at("not_observed").elements()) unobserved.push_back(name.as_text());
  EXPECT_EQ(unobserved, (std::vector<std::string>{"believed_block", "believed_block_mass", "believed_friction"}));
}

TEST_F(EstimateVerb, SaysWhichEstimatesAreTiedToOneAnother) {
  ASSERT_EQ(run("mpc pushed-block --set motion=steady --output steady.csv --quiet").code, 0);
  const Ended ended = run("estimate pushed-block --measurements steady.csv --output believed.csv");
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_NE(ended.out.find("better known together with believed_friction (correlation -0.99"), std::string::npos) << ended.out;
}

TEST_F(EstimateVerb, AMovingHorizonDoesNotReadTheTruth) {
  ASSERT_EQ(run("mpc pushed-block --seed 4 --set duration=1.5 --output push.csv --quiet").code, 0);
  const CsvTable record = read_csv(folder_->path("push.csv"), {{}, {}, true});
  {
    CsvWriter csv(folder_->path("scrambled.csv"), record.names);
    for (std::size_t k = 0; k < record.lines.size(); ++k) {
      for (const std::string& name : record.names) {
        const bool is_seen = name == "t" || name == "measured_finger" || name == "force";
        csv << (is_seen ? record[name][k] : 7.0 + static_cast<double>(k));
      }
      csv.end_row();
    }
    csv.finish();
  }
  EXPECT_EQ(run("estimate pushed-block --measurements push.csv --output one.csv").code, 0);
  EXPECT_EQ(run("estimate pushed-block --measurements scrambled.csv --output two.csv").code, 0);
  EXPECT_EQ(folder_->read("one.csv"), folder_->read("two.csv"));
}

TEST_F(EstimateVerb, AScriptHasNothingToPlanOrToSweep) {
  for (const std::string verb : {"plan", "sweep"}) {
    const Ended ended = run(verb + " pushed-block" + (verb == "sweep" ? " --samples 2" : ""));
    EXPECT_EQ(ended.code, 2);
    EXPECT_TRUE(is_one_line(ended.err, "tenon: pushed-block: has nothing to " + verb + ", its commands are a script")) << ended.err;
  }
}

// Experiments have their picture too.
TEST_F(EstimateVerb, MakesPagesOfTheExperimentAndOfWhatIsBelieved) {
  for (const std::string scene : {"pushed-block", "delta-payload"}) {
    EXPECT_EQ(run("mpc " + scene + " --set duration=0.2 --output " + scene + ".csv --report " + scene + ".html --quiet").code, 0);
    EXPECT_EQ(run("estimate " + scene + " --measurements " + scene + ".csv --report believed.html --quiet").code, 0);
    EXPECT_TRUE(folder_->has(scene + ".html"));
  }
  EXPECT_TRUE(folder_->has("believed.html"));
}

TEST_F(EstimateVerb, RefusesRecordsThatMakeNoSense) {
  const std::string text = folder_->read("run.csv");
  const std::size_t second = text.find('\n') + 1, third = text.find('\n', second) + 1;
  folder_->write("back.csv", text.substr(0, third) + text.substr(second, third - second));
  expect_bad_input("back.csv", "back.csv:3:1: the time does not go on");
  folder_->write("short.csv", "t,measured_x\n0,0\n");
  expect_bad_input("short.csv", "short.csv:1:1: column 'measured_z' is missing");
  expect_bad_input("nowhere.csv", "nowhere.csv:");
  const Ended ended = run("estimate cart-pole-soft-walls --measurements run.csv");
  EXPECT_EQ(ended.code, 2);
  EXPECT_TRUE(is_one_line(ended.err, "tenon: cart-pole-soft-walls: has nothing to estimate")) << ended.err;
}

TEST_F(EstimateVerb, MarginsAreThoseOfEveryModeAndOfCapture) {
  const Ended ended = run("sweep peg-in-hole --margins --samples 2 --json");
  ASSERT_EQ(ended.code, 0) << ended.err;
  const Json margins = Json::parse(ended.out, "stdout");
  const std::vector<Json> modes = margins.at("modes").elements();
  ASSERT_EQ(modes.size(), 5u);
  for (const Json& mode : modes) {
    EXPECT_GT(mode.at("modulus_margin").number(), 0.5) << mode.at("mode").as_text();
    EXPECT_GT(mode.at("delay_margin").number(), 0.002) << mode.at("mode").as_text();
  }
  EXPECT_GE(margins.at("capture").at("certain_to").number(), 1.1e-3);  // chamfer and half the clearance: that much without any controller
  EXPECT_EQ(run("sweep cart-pole-soft-walls --margins").code, 2);
}

}  // namespace
}  // namespace tenon
