// tenon sweep, as a script sees it: alone, on threads, under mpirun, killed and taken up again.
#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "tenon/apps/json.hpp"
#include "tenon/core/csv.hpp"
#include "tenon/tests/run_tenon.hpp"

namespace tenon {
namespace {

const std::string kSweep = "sweep cart-pole-soft-walls --samples 24";

class SweepVerb : public testing::Test {
 protected:
  std::string record_of(const std::string& arguments, const std::string& prefix = "") {
    const Ended ended = run_tenon(folder_, arguments + " --output out.csv --json", prefix);
    EXPECT_EQ(ended.code, 0) << ended.err;
    json_ = ended.out;
    return folder_.read("out.csv");
  }
  void expect_bad_input(const std::string& arguments, const std::string& line) {
    tenon::expect_bad_input(folder_, arguments, line);
  }

  ScratchFolder folder_;
  std::string json_;
};

TEST_F(SweepVerb, GivesTheSameTableOnAnyNumberOfThreads) {
  const std::string one = record_of(kSweep + " --threads 1");
  EXPECT_EQ(one, record_of(kSweep + " --threads 3"));
  EXPECT_EQ(std::count(one.begin(), one.end(), '\n'), 25);
  const Json json = Json::parse(json_, "stdout");
  EXPECT_EQ(json.at("samples").number(), 24);
  EXPECT_EQ(json.at("success_rate").number(), json.at("successes").number() / 24);
  EXPECT_LE(json.at("interval").elements()[0].number(), json.at("success_rate").number());
  EXPECT_GE(json.at("interval").elements()[1].number(), json.at("success_rate").number());
}

// An Ipopt from Debian in the program would make every process a world of its own.
TEST_F(SweepVerb, GivesTheSameTableUnderMpirunInAWorldOfTwo) {
  if (std::string(TENON_MPIRUN).empty()) GTEST_SKIP() << "built without MPI";
  const std::string alone = record_of(kSweep);
  EXPECT_EQ(Json::parse(json_, "stdout").at("processes").number(), 1);
  const std::string mpirun = "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 " TENON_MPIRUN " --oversubscribe -np 2";
  EXPECT_EQ(alone, record_of(kSweep, mpirun));
  EXPECT_EQ(Json::parse(json_, "stdout").at("processes").number(), 2);
}

TEST_F(SweepVerb, GoesOnWhereItWasKilled) {
  const std::string whole = record_of(kSweep);
  std::filesystem::remove(folder_.path("out.csv"));
  // Killed once five rows are on the disk.
  const std::string killed = "( '" TENON_BINARY "' sweep cart-pole-soft-walls --samples 24 --threads 1 --output out.csv & worker=$!; "
                             "while [ \"$(wc -l < out.csv.partial 2> /dev/null || echo 0)\" -lt 6 ] && kill -0 $worker 2> /dev/null; do sleep 0.01; done; "
                             "kill -9 $worker; wait $worker ) > /dev/null 2>&1";
  ASSERT_EQ(std::system(("cd '" + folder_.path("") + "' && { " + killed + "; true; }").c_str()), 0);
  const CsvTable partial = read_csv(folder_.path("out.csv.partial"));
  EXPECT_GE(partial.rows(), 5);
  EXPECT_LT(partial.rows(), 24);
  EXPECT_EQ(record_of(kSweep + " --resume"), whole);
  EXPECT_FALSE(folder_.has("out.csv.partial") || folder_.has("out.csv.partial.aside"));
}

TEST_F(SweepVerb, DoesNotGoOnWithAnotherSweep) {
  record_of(kSweep);
  const Ended ended = run_tenon(folder_, kSweep + " --output out.csv --resume --max-iterations 7");
  EXPECT_EQ(ended.code, 2);
  EXPECT_NE(ended.err.find("belong to another sweep"), std::string::npos) << ended.err;
}

TEST_F(SweepVerb, RefusesWhatMakesNoSense) {
  expect_bad_input("sweep cart-pole-soft-walls", "sweep: no samples (expected --samples N, at least 1)");
  expect_bad_input(kSweep + " --resume", "--resume: no record to go on with");
  expect_bad_input("sweep cart-pole-soft-wals --samples 3 --output out.csv", "");
  expect_bad_input(kSweep + " --output out.csv --set parameters.intervals=-1", "");
}

}  // namespace
}  // namespace tenon
