// Monte Carlo sweeps: rows that depend on their seed alone, statistics, and a record that loses nothing.
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tenon/apps/sweep/sweep_record.hpp"
#include "tenon/apps/sweep/sweep_summary.hpp"
#include "tenon/core/input_error.hpp"
#include "tenon/core/read_file.hpp"
#include "tenon/mpc/monte_carlo.hpp"
#include "tenon/mpc/paired_experiments.hpp"
#include "tenon/mpc/success_interval.hpp"

namespace fs = std::filesystem;

namespace tenon {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Throws a dart at a board of radius 1 from a square of half side `side`.
class Dart final : public Experiment {
 public:
  explicit Dart(double side) : side_(side) {}
  std::vector<std::string> names() const override { return {"x", "y", "success", "distance"}; }
  std::string severity() const override { return "distance"; }
  void run(std::uint64_t seed, VectorRef row) override {
    if (seed == 0) throw std::runtime_error("a broken dart");
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const double x = uniform(random), y = uniform(random), distance = side_ * std::hypot(x, y);
    row << x, y, distance <= 1 ? 1 : 0, distance <= 1 ? distance : std::nan("");
  }

 private:
  double side_;
};

ExperimentFactory darts(double side = 1) {
  return [side] { return std::make_unique<Dart>(side); };
}

std::vector<std::uint64_t> seeds(int count, std::uint64_t first = 1) {
  std::vector<std::uint64_t> all;
  for (int k = 0; k < count; ++k) all.push_back(first + static_cast<std::uint64_t>(k));
  return all;
}

std::map<std::uint64_t, Vector> sweep(const ExperimentFactory& make, int count, int threads) {
  std::map<std::uint64_t, Vector> rows;
  run_samples(make, seeds(count), threads, {.on_row = [&](std::uint64_t seed, const Vector& row) { rows.emplace(seed, row); }});
  return rows;
}

bool same_bits(const Vector& a, const Vector& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), static_cast<std::size_t>(a.size()) * sizeof(double)) == 0;
}

TEST(MonteCarlo, GivesTheSameRowsWhateverTheNumberOfWorkers) {
  const auto one = sweep(darts(), 200, 1), four = sweep(darts(), 200, 4);
  ASSERT_EQ(one.size(), 200u);
  ASSERT_EQ(four.size(), 200u);
  for (const auto& [seed, row] : one) EXPECT_TRUE(same_bits(row, four.at(seed))) << seed;
}

TEST(MonteCarlo, FindsThePartOfASquareThatADiscFills) {
  int hits = 0;
  for (const auto& [seed, row] : sweep(darts(), 4000, 2)) hits += row[2] == 1;
  const SuccessInterval interval = success_interval(hits, 4000, 0.999);
  EXPECT_LT(interval.lower, M_PI / 4);
  EXPECT_GT(interval.upper, M_PI / 4);
}

TEST(MonteCarlo, EndsWithTheExceptionOfARun) {
  EXPECT_THROW(run_samples(darts(), seeds(100, 0), 3, {.on_row = [](std::uint64_t, const Vector&) {}}), std::runtime_error);
}

TEST(MonteCarlo, StopsBetweenRunsWhereItIsToldTo) {
  std::size_t rows = 0;
  const auto many = seeds(1'000'000);
  run_samples(darts(), many, 2, {.on_row = [&](std::uint64_t, const Vector&) { ++rows; }, .go_on = [&] { return rows < 100; }});
  EXPECT_GE(rows, 100u);
  EXPECT_LT(rows, many.size());
}

TEST(MonteCarlo, RunsNothingWhereThereIsNothingToRun) {
  EXPECT_TRUE(sweep(darts(), 0, 2).empty());
  EXPECT_THROW(sweep(darts(), 1, 0), std::invalid_argument);
}

// The bounds of Clopper and Pearson in closed form where all succeed or fail, and a value of their table (95 %, 8 of 10).
TEST(SuccessInterval, IsThatOfClopperAndPearson) {
  EXPECT_NEAR(success_interval(500, 500).lower, std::pow(0.025, 1.0 / 500), 1e-12);
  EXPECT_EQ(success_interval(500, 500).upper, 1);
  EXPECT_NEAR(success_interval(0, 40).upper, 1 - std::pow(0.025, 1.0 / 40), 1e-12);
  EXPECT_EQ(success_interval(0, 40).lower, 0);
  EXPECT_NEAR(success_interval(8, 10).lower, 0.4439, 1e-4);
  EXPECT_NEAR(success_interval(8, 10).upper, 0.9748, 1e-4);
}

TEST(PairedExperiments, RunInTheSameWorlds) {
  std::vector<PairedExperiments::Named> both;
  both.emplace_back("near", std::make_unique<Dart>(1));
  both.emplace_back("far", std::make_unique<Dart>(2));
  PairedExperiments pair(std::move(both));
  EXPECT_THAT(pair.names(), ElementsAre("x", "y", "success", "distance", "far.success", "far.distance"));
  Vector row(6), near(4), far(4);
  pair.run(7, row);
  Dart(1).run(7, near), Dart(2).run(7, far);
  EXPECT_TRUE(same_bits(row.head(4), near));
  EXPECT_TRUE(same_bits(row.tail(2), far.tail(2)));
}

class Record : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("tenon_sweep_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    file_ = (folder_ / "darts.csv").string();
  }
  void TearDown() override { fs::remove_all(folder_); }

  SweepRecord open(bool resume, const std::string& identity = "{}\n") { return SweepRecord(file_, Dart(1).names(), identity, resume); }
  std::string whole() {
    SweepRecord record = open(false);
    for (const auto& [seed, row] : rows_) record.add(seed, row);
    record.finish();
    return read_file(file_);
  }

  const std::map<std::uint64_t, Vector> rows_ = sweep(darts(), 20, 1);
  fs::path folder_;
  std::string file_;
};

TEST_F(Record, IsTheSameWhateverTheOrderOfRows) {
  const std::string sorted = whole();
  SweepRecord record = open(false);
  for (auto row = rows_.rbegin(); row != rows_.rend(); ++row) record.add(row->first, row->second);
  record.finish();
  EXPECT_EQ(read_file(file_), sorted);
}

TEST_F(Record, GoesOnWhereItWasCutOff) {
  const std::string sorted = whole();
  fs::remove(file_);
  {
    SweepRecord record = open(false);
    for (const std::uint64_t seed : {3, 11, 5}) record.add(seed, rows_.at(seed));
  }
  std::ofstream(file_ + ".partial", std::ios::app) << "12,0.25,0.";  // a line that did not get out whole
  SweepRecord record = open(true);
  EXPECT_EQ(record.rows().size(), 3u);
  for (const auto& [seed, row] : rows_) record.add(seed, row);
  record.finish();
  EXPECT_EQ(read_file(file_), sorted);
}

TEST_F(Record, LosesNothingWhereTheProgramEndsWhileItIsTakenOver) {
  {
    SweepRecord record = open(false);
    for (const std::uint64_t seed : {3, 11}) record.add(seed, rows_.at(seed));
  }
  fs::rename(file_ + ".partial", file_ + ".partial.aside");
  EXPECT_EQ(open(true).rows().size(), 2u);
  EXPECT_FALSE(fs::exists(file_ + ".partial.aside"));
}

TEST_F(Record, DoesNotMixTwoSweeps) {
  { open(false).add(1, rows_.at(1)); }
  try {
    open(true, "{\"scene\": \"another\"}\n");
    FAIL() << "taken over";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("another sweep"));
  }
}

TEST(SweepSummary, ComparesAndNamesTheWorst) {
  std::map<std::uint64_t, Vector> rows;
  const auto add = [&](std::uint64_t seed, std::array<double, 4> values) { rows.emplace(seed, Eigen::Map<Vector>(values.data(), 4)); };
  add(1, {0.1, 1, 5, 1});
  add(2, {0.2, 1, 9, 0});
  add(3, {0.3, 1, 7, 0});
  SweepSummary summary("darts", {"offset", "success", "force", "script.success"}, "force", rows);
  EXPECT_EQ(summary.json().at("success_rate").number(), 1);
  EXPECT_EQ(summary.json().at("percentiles").at("force").at("median").number(), 7);
  EXPECT_EQ(summary.json().at("worst").at("seed").number(), 2);
  EXPECT_EQ(summary.json().at("baselines").elements().front().at("successes").number(), 1);

  add(4, {0.4, 0, 1, 0});  // a failure is worse than any force
  summary = SweepSummary("darts", {"offset", "success", "force", "script.success"}, "force", rows);
  EXPECT_EQ(summary.json().at("worst").at("seed").number(), 4);
  EXPECT_THAT(summary.text(), HasSubstr("3/4"));
}

}  // namespace
}  // namespace tenon
