// .nl files on the command line: solve, check and compare; the AMPL protocol, its answer read back; dumps that fail again; profiles.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "tenon/core/csv.hpp"
#include "tenon/problems/nl/nl_file.hpp"
#include "tenon/tests/nl_folder.hpp"
#include "tenon/tests/run_tenon.hpp"

namespace tenon {
namespace {

class NlCommands : public testing::Test {
 protected:
  void SetUp() override {
    if (!nl_files_are_available()) GTEST_SKIP() << "built without the AMPL solver library";
    for (const auto& entry : std::filesystem::directory_iterator(TENON_SOURCE_DIR "/tests/data/nl")) {
      std::filesystem::copy(entry.path(), folder_.path(entry.path().filename().string()));
    }
  }

  Ended run(const std::string& arguments) { return run_tenon(folder_, arguments); }

  void expect_bad_input(const std::string& arguments, const std::string& line) {
    tenon::expect_bad_input(folder_, arguments, line);
  }

  ScratchFolder folder_;
};

/// A .sol file, read as AMPL reads it.
struct Solution {
  std::string message;
  std::vector<int> options;
  std::vector<double> dual, primal;
  int objective = -99, code = -99;
};

Solution parse_sol(const std::string& text) {
  Solution solution;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line) && !line.empty();) solution.message += line;
  std::string word;
  int count = 0, rows = 0, duals = 0, variables = 0, primals = 0;
  EXPECT_TRUE(in >> word && word == "Options");
  in >> count;
  for (int option = 0; count > 0 && in >> option; --count) solution.options.push_back(option);
  in >> rows >> duals >> variables >> primals;
  EXPECT_EQ(rows, duals);
  EXPECT_EQ(variables, primals);
  for (double value = 0; duals > 0 && in >> value; --duals) solution.dual.push_back(value);
  for (double value = 0; primals > 0 && in >> value; --primals) solution.primal.push_back(value);
  EXPECT_TRUE(in >> word >> solution.objective >> solution.code && word == "objno");
  EXPECT_FALSE(in >> word) << word;
  return solution;
}

TEST_F(NlCommands, SolveSaysTheFilesObjectiveAndNames) {
  const Ended ended = run("solve garden.nl");
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_NE(ended.out.find("objective     1.03749"), std::string::npos) << ended.out;  // the maximum, not its negative
  EXPECT_NE(ended.out.find("depth"), std::string::npos) << ended.out;
  EXPECT_NE(run("solve garden_binary.nl --json").out.find("\"objective\": 1.0374999"), std::string::npos);
  EXPECT_EQ(run("check operators.nl").code, 0);
  EXPECT_NE(run("compare garden.nl hs071 --solvers newton-kkt").out.find("garden.nl"), std::string::npos);
}

TEST_F(NlCommands, AnInfeasibleFileNamesTheRows) {
  const Ended ended = run("solve conflict.nl");
  EXPECT_EQ(ended.code, 1);
  EXPECT_NE(ended.out.find("c[2] = "), std::string::npos) << ended.out;
}

TEST_F(NlCommands, ABrokenFileIsBadInput) {
  folder_.write("cut.nl", nl_text("garden").substr(0, 300));
  expect_bad_input("solve cut.nl", "cut.nl:");
  expect_bad_input("solve none.nl", "none.nl: cannot be read: No such file");
  expect_bad_input("cut -AMPL", "cut.nl:");
  EXPECT_FALSE(folder_.has("cut.sol"));
}

TEST_F(NlCommands, AmplReadsTheAnswerBack) {
  const Ended ended = run("garden -AMPL tol=1e-10 outlev=1");
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_EQ(ended.err, "");
  const Solution solution = parse_sol(folder_.read("garden.sol"));
  EXPECT_NE(solution.message.find("solved"), std::string::npos);
  EXPECT_NE(solution.message.find("objective 1.0375"), std::string::npos) << solution.message;
  EXPECT_EQ(solution.options, (std::vector<int>{1, 1, 0}));
  EXPECT_EQ(solution.objective, 0);
  EXPECT_EQ(solution.code, 0);
  ASSERT_EQ(solution.primal.size(), 4U);
  EXPECT_NEAR(solution.primal[0], 1.75, 1e-6);
  ASSERT_EQ(solution.dual.size(), 4U);
  // The budget x + y <= b binds, x = y: one more of it is worth d/db (b^2/4 - 0.1 (b + 1)^2) = b/2 - 0.2 (b + 1).
  EXPECT_NEAR(solution.dual[3], 3.5 / 2 - 0.2 * 4.5, 1e-6);
}

TEST_F(NlCommands, AMinimisedFilesMultiplierIsTheRateOfTheOptimum) {
  // min x + y over x + y >= 2 and 0 <= x, y <= 10: one more is worth one more.
  folder_.write("rate.nl", replaced(nl_text("conflict"), "r\n11\n13\n24\n", "r\n1100\n22\n3\n"));
  const Ended ended = run("rate.nl -AMPL");
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_NEAR(parse_sol(folder_.read("rate.sol")).dual[1], 1, 1e-6);
}

TEST_F(NlCommands, EveryEndWritesAnAnswer) {
  EXPECT_EQ(run("conflict -AMPL").code, 0);
  EXPECT_EQ(parse_sol(folder_.read("conflict.sol")).code, 200);
  EXPECT_EQ(run("bottomless -AMPL").code, 0);
  EXPECT_EQ(parse_sol(folder_.read("bottomless.sol")).code, 300);
  EXPECT_EQ(run("undefined -AMPL").code, 0);
  EXPECT_EQ(parse_sol(folder_.read("undefined.sol")).code, 500);
  EXPECT_EQ(run("valley -AMPL max_iter=3").code, 0);
  EXPECT_EQ(parse_sol(folder_.read("valley.sol")).code, 400);
  EXPECT_EQ(run("valley -AMPL timelimit=0").code, 0);
  EXPECT_EQ(parse_sol(folder_.read("valley.sol")).code, 401);
  EXPECT_EQ(run("garden -AMPL objno=2").code, 0);
  EXPECT_EQ(parse_sol(folder_.read("garden.sol")).objective, 1);
}

TEST_F(NlCommands, OptionsComeFromTheEnvironmentToo) {
  const std::string command =
      "cd '" + folder_.path("") + "' && tenon_options='max_iter=2 nonsense=1' '" TENON_BINARY "' valley -AMPL > stdout.txt 2> stderr.txt";
  EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 0);
  EXPECT_EQ(parse_sol(folder_.read("valley.sol")).code, 400);
  EXPECT_TRUE(is_one_line(folder_.read("stderr.txt"), "tenon: option 'nonsense' is not known")) << folder_.read("stderr.txt");
  expect_bad_input("valley -AMPL max_iter=many", "-AMPL max_iter=many makes no sense");
  expect_bad_input("-AMPL", "-AMPL: nothing named");
}

TEST_F(NlCommands, ADumpFailsAgain) {
  const Ended first = run("solve conflict.nl --dump failed.json --tolerance 1e-7");
  EXPECT_EQ(first.code, 1);
  std::filesystem::remove(folder_.path("conflict.nl"));  // the dump holds the problem itself
  const Ended again = run("solve failed.json --json");
  EXPECT_EQ(again.code, 1) << again.err;
  EXPECT_NE(again.out.find("\"status\": \"infeasible\""), std::string::npos);
  EXPECT_NE(run("compare failed.json --solvers newton-kkt").out.find("tolerance 1e-07"), std::string::npos);

  EXPECT_EQ(run("solve garden_binary.nl --max-iterations 2 --dump binary.json").code, 1);
  EXPECT_NE(folder_.read("binary.json").find("\"nl_hex\""), std::string::npos);
  EXPECT_EQ(run("solve binary.json").code, 1);
  EXPECT_EQ(run("solve binary.json --max-iterations 100").code, 0);
  EXPECT_EQ(run("solve hs071 --max-iterations 1 --dump hs.json").code, 1);
  EXPECT_EQ(run("compare hs.json --max-iterations 100").code, 0);
}

TEST_F(NlCommands, ASolveThatSucceedsLeavesNoDump) {
  EXPECT_EQ(run("solve valley.nl --dump none.json").code, 0);
  EXPECT_FALSE(folder_.has("none.json"));
}

TEST_F(NlCommands, ABrokenDumpIsBadInput) {
  expect_bad_input("solve none.json", "none.json: cannot be read");
  folder_.write("a.json", "{\n  \"schema\": 1,\n  ]");
  expect_bad_input("solve a.json", "a.json:3:3: this is no JSON");
  folder_.write("a.json", "{\"schema\": 1}");
  expect_bad_input("solve a.json", "a.json: the key 'problem' is missing");
  run("solve valley.nl --max-iterations 1 --dump v.json");
  folder_.write("a.json", replaced(folder_.read("v.json"), "\"lambda\": []", "\"lambda\": [1.0]"));
  expect_bad_input("solve a.json", "a.json: point.lambda has 1 entries (expected 0)");
  folder_.write("a.json", replaced(folder_.read("v.json"), "O0 0", "O7 0"));
  expect_bad_input("solve a.json", "a.json: the problem within: valley.nl:");
}

TEST_F(NlCommands, AProfileIsACurveForEachSolverThatRises) {
  const Ended ended = run("compare --profile . --solvers newton-kkt,nlopt-slsqp --output p --time-limit 1");
  EXPECT_EQ(ended.code, 0) << ended.err;
  const CsvTable curves = read_csv(folder_.path("p.csv"), {{"ratio", "newton-kkt", "nlopt-slsqp"}, {}});
  for (const char* solver : {"newton-kkt", "nlopt-slsqp"}) {
    for (int k = 1; k < curves.rows(); ++k) {
      const auto at = static_cast<std::size_t>(k);
      if (curves["ratio"][at] < curves["ratio"][at - 1]) continue;  // the next cost begins
      EXPECT_GE(curves[solver][at], curves[solver][at - 1]);
      EXPECT_LE(curves[solver][at], 1);
    }
  }
  EXPECT_TRUE(folder_.read("p.svg").starts_with("<svg xmlns="));
  EXPECT_NE(folder_.read("p.svg").find(">newton-kkt</text>"), std::string::npos);
  const std::string table = folder_.read("p_problems.csv");
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 1 + 2 * 8);
  EXPECT_NE(table.find("\nconflict,2,3,newton-kkt,infeasible,"), std::string::npos) << table;
  expect_bad_input("compare --profile none", "none: cannot be read as a folder");
  expect_bad_input("compare", "compare: nothing named");
}

}  // namespace
}  // namespace tenon
