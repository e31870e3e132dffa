// Tables in and out: what is wrong is said with its place, what is written reads back bit for bit and is whole or not there.
#include "tenon/core/csv.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tenon/tests/expect_message.hpp"
#include "tenon/tests/scratch_folder.hpp"

namespace tenon {
namespace {

TEST(Csv, ReadsNumbersWithBlanksQuotesAndWindowsLineEnds) {
  const CsvTable table = parse_csv("\xEF\xBB\xBFt, \"F x\"\r\n0, 1.5\r\n\r\n+1,-2e-3\r\n", "a.csv");
  EXPECT_EQ(table.rows(), 2);
  EXPECT_EQ(table["F x"][1], -2e-3);
  EXPECT_EQ(table["t"][1], 1);
  EXPECT_EQ(table.lines[1], 4);
}

TEST(Csv, SkipsColumnsThatNobodyAskedFor) {
  const CsvTable table = parse_csv("t,note,u\n0,hello,1\n1,\"a, b\",nan\n", "a.csv", {{"t"}, {"x"}});
  EXPECT_EQ(table.names, std::vector<std::string>{"t"});
  EXPECT_FALSE(table.has("x"));
}

TEST(Csv, SaysWhatIsWrongAndWhere) {
  EXPECT_MESSAGE(parse_csv("", "a.csv"), InputError, "a.csv:1:1: the file is empty");
  EXPECT_MESSAGE(parse_csv("t,u\n", "a.csv"), InputError, "a.csv:2:1: there is no row");
  EXPECT_MESSAGE(parse_csv("t,u\n1\n", "a.csv"), InputError, "a.csv:2:2: the row has 1 cells (expected 2");
  EXPECT_MESSAGE(parse_csv("t,u\n1,2\n1,2,3\n", "a.csv"), InputError, "a.csv:3:5: the row has 3 cells");
  EXPECT_MESSAGE(parse_csv("t,u\n1,two\n", "a.csv"), InputError, "a.csv:2:3: column 'u' holds 'two' (expected a number)");
  EXPECT_MESSAGE(parse_csv("t,u\n1,\n", "a.csv"), InputError, "a.csv:2:3: column 'u' is empty");
  EXPECT_MESSAGE(parse_csv("t,u\n1,nan\n", "a.csv"), InputError, "a.csv:2:3: column 'u' holds 'nan' (expected a finite number)");
  EXPECT_MESSAGE(parse_csv("t,u\n1,-inf\n", "a.csv"), InputError, "expected a finite number");
  EXPECT_MESSAGE(parse_csv("t,u\n1,1e999\n", "a.csv"), InputError, "a.csv:2:3");
  EXPECT_MESSAGE(parse_csv("t,u,t\n1,2,3\n", "a.csv"), InputError, "a.csv:1:5: column 't' stands twice");
  EXPECT_MESSAGE(parse_csv("t,u\n1,2\n", "a.csv", {{"t", "v"}, {}}), InputError, "a.csv:1:1: column 'v' is missing");
  EXPECT_MESSAGE(read_csv("no/such/file.csv"), InputError, "no/such/file.csv: cannot be read");
}

TEST(Csv, WhatIsWrittenReadsBackBitForBit) {
  const ScratchFolder folder;
  std::mt19937_64 random(7);
  std::vector<double> values;
  for (int k = 0; k < 1000; ++k) values.push_back(std::ldexp(std::uniform_real_distribution<double>(-1, 1)(random), k % 200 - 100));
  CsvWriter writer(folder.path("x.csv"), {"a", "b"});
  for (const double v : values) {
    writer << v << -v;
    writer.end_row();
  }
  EXPECT_FALSE(folder.has("x.csv"));
  writer.finish();
  EXPECT_FALSE(folder.has("x.csv.partial"));
  EXPECT_EQ(read_csv(folder.path("x.csv"))["a"], values);
}

TEST(Csv, AnEarlyEndLeavesCompleteRowsInPartialAndTheOldFileAlone) {
  const ScratchFolder folder;
  folder.write("x.csv", "old");
  {
    CsvWriter writer(folder.path("x.csv"), {"a", "b"});
    writer << 1 << 2;
    writer.end_row();
    writer << 3;
  }
  EXPECT_EQ(folder.read("x.csv"), "old");
  EXPECT_EQ(folder.read("x.csv.partial"), "a,b\n1,2\n");
}

TEST(Csv, AFullDiskIsAnOutputError) {
  CsvWriter writer("/dev/full", {"a"});
  writer << 1;
  writer.end_row();
  EXPECT_MESSAGE(writer.finish(), OutputError, "/dev/full: cannot be written");
}

TEST(Csv, AFolderThatIsNotThereIsAnInputError) {
  const ScratchFolder folder;
  EXPECT_MESSAGE(CsvWriter(folder.path("no/x.csv"), {"a"}), InputError, "is not there");
  EXPECT_MESSAGE(CsvWriter(folder.path(""), {"a"}), InputError, "no name");
}

TEST(Csv, ARowOfTheWrongLengthIsABugOfTheCaller) {
  const ScratchFolder folder;
  CsvWriter writer(folder.path("x.csv"), {"a", "b"});
  writer << 1;
  EXPECT_THROW(writer.end_row(), std::logic_error);
}

}  // namespace
}  // namespace tenon
