// .nl files: what they say arrives as they say it, what this program does not take is refused by name, and .sol answers in AMPL's sign.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <random>

#include "tenon/core/check_derivatives.hpp"
#include "tenon/core/csv.hpp"
#include "tenon/core/kkt_residual.hpp"
#include "tenon/problems/nl/nl_scan.hpp"
#include "tenon/problems/nl/sol_file.hpp"
#include "tenon/solvers/make_solver.hpp"
#include "tenon/tests/expect_message.hpp"
#include "tenon/tests/nl_folder.hpp"

namespace tenon {
namespace {

class Nl : public testing::Test {
 protected:
  void SetUp() override {
    if (!nl_files_are_available()) GTEST_SKIP() << "built without the AMPL solver library";
  }
};
using NlFiles = Nl;
using NlSolves = Nl;

double objective_at(const Nlp& problem, const Vector& x) {
  Nlp::Workspace workspace = problem.make_workspace();
  problem.prepare(x, workspace);
  return problem.objective(x, workspace);
}

Vector values(std::initializer_list<double> list) { return Eigen::Map<const Vector>(list.begin(), static_cast<Eigen::Index>(list.size())); }

TEST_F(NlFiles, SayBoundsStartMultipliersAndNames) {
  const NlFile file = read_nl(nl_path("garden"));
  const Nlp& problem = *file.problem;
  ASSERT_EQ(problem.num_variables(), 4);
  ASSERT_EQ(problem.num_constraints(), 4);
  EXPECT_TRUE(file.maximises);
  EXPECT_EQ(file.objective, 1);
  EXPECT_EQ(file.start.x, values({1, 1.5, 0.5, 0.25}));
  EXPECT_EQ(file.start.lambda, values({0.5, 0, -1, 0.25}));  // maximised: AMPL's sign is ours of -f
  Bounds bounds(4, 4);
  problem.bounds(bounds);
  constexpr double kNone = kInfinity<double>;
  EXPECT_EQ(bounds.x_lower, values({0, 0, -kNone, -1}));
  EXPECT_EQ(bounds.x_upper, values({10, kNone, kNone, 1}));
  EXPECT_EQ(bounds.c_lower, values({1, -kNone, 0, -kNone}));
  EXPECT_EQ(bounds.c_upper, values({8, kNone, 0, 3.5}));
  EXPECT_EQ(problem.name(), "garden");
  EXPECT_EQ(problem.variable_name(3), "unused");
  EXPECT_EQ(problem.constraint_name(2), "balance");
  EXPECT_EQ(read_nl(nl_path("valley")).problem->variable_name(1), "x[1]");
}

TEST_F(NlFiles, SayTheFunctions) {
  const NlFile file = read_nl(nl_path("garden"));
  const Vector x = values({2, 1.5, 0.5, -1});
  const double v = 2 + 1.5 + 1;
  EXPECT_DOUBLE_EQ(objective_at(*file.problem, x), -(2 * 1.5 - 0.1 * v * v));
  Nlp::Workspace workspace = file.problem->make_workspace();
  Vector rows(4);
  file.problem->constraints(x, workspace, rows);
  EXPECT_EQ(rows, values({4 + 2.25, 2 * v, 2 - 3 + 0.5, 3.5}));
}

TEST_F(NlFiles, ObeyTheDerivativeLaw) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (const char* name : {"garden", "garden_binary", "valley", "crossing", "conflict", "bottomless", "operators"}) {
    const NlFile file = read_nl(nl_path(name));
    for (int repetition = 0; repetition < 5; ++repetition) {
      const Vector lambda = Vector::NullaryExpr(file.problem->num_constraints(), [&](auto) { return normal(random); });
      const Vector x = file.start.x + Vector::NullaryExpr(file.start.x.size(), [&](auto) { return 0.02 * normal(random); });
      const DerivativeReport report = check_derivatives(*file.problem, x, normal(random), lambda);
      EXPECT_TRUE(report.passed(1e-6)) << name << ": " << report.gradient_error << " " << report.jacobian_error << " " << report.hessian_error;
    }
  }
}

TEST_F(NlFiles, BinarySaysTheSameAsText) {
  const NlFile text = read_nl(nl_path("garden")), binary = read_nl(nl_path("garden_binary"));
  EXPECT_EQ(text.start.x, binary.start.x);
  EXPECT_EQ(text.start.lambda, binary.start.lambda);
  EXPECT_EQ(text.problem->jacobian_pattern(), binary.problem->jacobian_pattern());
  EXPECT_EQ(text.problem->hessian_pattern(), binary.problem->hessian_pattern());
  const Vector x = values({0.3, 2, -1, 0.5});
  EXPECT_EQ(objective_at(*text.problem, x), objective_at(*binary.problem, x));
}

TEST_F(NlFiles, TheObjectiveIsTheOneThatIsAskedFor) {
  const Vector x = values({2, 1.5, 0.5, -1});
  const NlFile second = read_nl(nl_path("garden"), 2);
  EXPECT_FALSE(second.maximises);
  EXPECT_EQ(objective_at(*second.problem, x), 7.5 + 0.5);
  EXPECT_TRUE(check_derivatives(*second.problem, x, 2, values({1, 2, 3, 4})).passed(1e-6));
  const NlFile none = read_nl(nl_path("garden"), 0);
  EXPECT_EQ(objective_at(*none.problem, x), 0);
  EXPECT_EQ(none.objective, 0);
  EXPECT_TRUE(check_derivatives(*none.problem, x, 2, values({1, 2, 3, 4})).passed(1e-6));
  EXPECT_EQ(read_nl(nl_path("crossing")).objective, 0);
  EXPECT_MESSAGE(read_nl(nl_path("garden"), 3), std::invalid_argument, "there is no objective 3 (expected 0 to 2)");
}

TEST_F(NlFiles, WhatCannotBeEvaluatedIsNotANumberAndHarmsNothingElse) {
  const NlFile file = read_nl(nl_path("undefined"));
  const Vector bad = values({-1}), good = values({2});
  Nlp::Workspace workspace;
  const auto look = [&](const Vector& x) {
    double hessian = 0;
    Vector gradient(1);
    file.problem->prepare(x, workspace);
    file.problem->hessian(x, 1, Vector(), workspace, {&hessian, 1});
    file.problem->gradient(x, workspace, gradient);
    return std::array{file.problem->objective(x, workspace), gradient[0], hessian};
  };
  for (int repetition = 0; repetition < 2; ++repetition) {
    for (const double value : look(bad)) EXPECT_TRUE(std::isnan(value));
    EXPECT_EQ(look(good), (std::array{2 - std::log(2), 0.5, 0.25}));
  }
}

TEST_F(NlFiles, TwoWorkspacesDoNotDisturbEachOther) {
  const NlFile file = read_nl(nl_path("garden"));
  const Vector here = values({2, 1.5, 0.5, -1}), there = values({1, 1, 1, 1});
  Nlp::Workspace a = file.problem->make_workspace(), b = file.problem->make_workspace();
  file.problem->prepare(here, a);
  const double before = file.problem->objective(here, a);
  file.problem->prepare(there, b);
  static_cast<void>(file.problem->objective(there, b));
  EXPECT_EQ(file.problem->objective(here, a), before);
}

// What is wrong, and where.

void expect_refused(const std::string& text, const std::string& message) {
  EXPECT_MESSAGE(scan_nl(text, "a.nl"), InputError, message);
}

TEST(NlScan, RefusesByNameWhatIsNotSmooth) {
  const std::string text = nl_text("garden");
  expect_refused(replaced(text, " 0 0 0 0 0\t# discrete", " 1 0 0 0 0\t# discrete"), "a.nl:7:11: the problem has integer variables (1)");
  expect_refused(replaced(text, " 2 1\t# nonlinear rows", " 2 1 1 0\t# nonlinear rows"), "a.nl:3:9: the problem has complementarity conditions (1)");
  expect_refused(replaced(text, " 0 0 1 0\n", " 0 2 1 0\n"), "imported functions (2)");
  expect_refused(replaced(text, " 4 4 2 0 1 0\t#", " 4 4 2 0 1 3\t#"), "logical constraints (3)");
  expect_refused(replaced(text, "r\n01 8", "r\n51 2"), "a complementarity condition");
  expect_refused(replaced(text, "C0\no0", "C0\no59"), "the operator 'count' is not taken");
  expect_refused(replaced(text, "o0\no5", "o0\nf0 1"), "an imported function is called");
  expect_refused(replaced(text, " 0 0 1 0\n", " 0 0 2 0\n"), "another kind of machine");
}

TEST(NlScan, NamesThePlaceOfAWrongWord) {
  const std::string text = nl_text("garden");
  expect_refused("", "a.nl:1:1: the file ends too early (expected g or b, the kind of file)");
  expect_refused("{}\n", "a.nl:1:1: this is no .nl file");
  expect_refused(replaced(text, "v0\n", "v9\n"), "found 9 (expected a variable or common expression");
  expect_refused(replaced(text, "01 8\n", "01e20 8\n"), "nothing can meet a bound so far out");
  expect_refused(replaced(text, "C1\n", "C7\n"), "found 7 (expected a row from 0 to 3)");
  expect_refused(replaced(text, "C1\n", "C0\n"), "this row stands twice");
  expect_refused(replaced(text, "o2\nv0\nv4", "o8\nv0\nv4"), "there is no operator 8");
  expect_refused(replaced(text, "n1\n", "n1x\n"), "found '1x' (expected a number)");
  expect_refused(replaced(text, "n1\n", "n1e999\n"), "found '1e999'");
  expect_refused(replaced(text, "01 8\n", "08 1\n"), "the lower bound of a row is above the upper one");
  expect_refused(replaced(text, "k3\n", "k2\n"), "found 2 (expected the count of columns but one from 3 to 3)");
  expect_refused(replaced(text, "J0 2\n0 0\n", "J0 2\n3 0\n"), "column 0 of the Jacobian has 3 non-zeros (expected 4, as segment k says)");
  expect_refused(replaced(text, " 4 4 2", " 200000000 4 2"), "a.nl:10:11: the header counts more than the file can hold (200000000)");
  expect_refused(text.substr(0, text.size() - 1), "the last line has no end");
  expect_refused(text + "Q\n", "no segment begins with 'Q'");
}

TEST(NlScan, FindsWhatIsMissing) {
  const std::string text = nl_text("garden");
  const std::size_t rows = text.find("r\n01 8"), bounds = text.find("b\n0"), last = text.find("G1");
  expect_refused(text.substr(0, rows) + text.substr(bounds), "the file ends without the ranges of the rows");
  expect_refused(text.substr(0, last), "there are 2 non-zeros of the gradients (expected 3, as the head says)");
  expect_refused(replaced(text, "J0 2\n0 0\n1 0\nJ1 2\n0 0\n1 0\n", "J0 2\n0 0\n2 0\nJ1 2\n0 0\n1 0\n"), "of the Jacobian has");
}

TEST(NlScan, AnExpressionMayBeDeepButNotBottomless) {
  const auto nested = [](int levels) {
    std::string signs;
    for (int k = 0; k < levels; ++k) signs += "o16\n";
    return replaced(nl_text("valley"), "O0 0\n", "O0 0\n" + signs);
  };
  EXPECT_EQ(scan_nl(nested(4000), "a.nl").header.variables, 2);
  expect_refused(nested(6000), "the expression is nested too deeply");
}

TEST_F(NlFiles, TheDeepestExpressionThatPassesIsEvaluated) {
  std::string text = nl_text("valley"), signs;
  for (int k = 0; k < 4990; ++k) signs += "o16\n";
  const NlFile file = parse_nl(replaced(text, "O0 0\n", "O0 0\n" + signs), "deep.nl");
  EXPECT_NEAR(objective_at(*file.problem, file.start.x), 24.2, 1e-12);
  EXPECT_TRUE(check_derivatives(*file.problem, file.start.x, 1, Vector()).passed(1e-6));
}

// Answers.

TEST_F(NlSolves, EveryStatusHasItsCode) {
  EXPECT_EQ(ampl_code(Status::solved), 0);
  EXPECT_EQ(ampl_code(Status::acceptable), 100);
  EXPECT_EQ(ampl_code(Status::infeasible), 200);
  EXPECT_EQ(ampl_code(Status::unbounded), 300);
  EXPECT_EQ(ampl_code(Status::iteration_limit), 400);
  EXPECT_EQ(ampl_code(Status::time_limit), 401);
  EXPECT_EQ(ampl_code(Status::stopped), 402);
  EXPECT_EQ(ampl_code(Status::invalid_start), 500);
  EXPECT_EQ(ampl_code(Status::numerical_failure), 500);
}

TEST_F(NlSolves, TheSolFileRepeatsOptionsAndTurnsMultipliers) {
  NlFile file;
  file.options = {1, 1, 0};
  file.objective = 2;
  Point point(2, 1);
  point.x << 0.1, -3;
  point.lambda << 2.5;
  EXPECT_EQ(sol_text(file, point, Status::infeasible, "words"), "words\n\nOptions\n3\n1\n1\n0\n1\n1\n2\n2\n-2.5\n0.1\n-3\nobjno 1 200\n");
  file.maximises = true;
  file.options = {1, 3, 0};
  file.boundary_tolerance = 0.5;
  EXPECT_EQ(sol_text(file, point, Status::solved, "words"), "words\n\nOptions\n5\n1\n3\n0\n1\n1\n2\n2\n0.5\n2.5\n0.1\n-3\nobjno 1 0\n");
}

TEST_F(NlSolves, EachFileEndsAsItMust) {
  const std::map<std::string, Status> expected = {{"garden", Status::solved},       {"garden_binary", Status::solved},
                                                  {"valley", Status::solved},       {"crossing", Status::solved},
                                                  {"operators", Status::solved},    {"conflict", Status::infeasible},
                                                  {"bottomless", Status::unbounded}, {"undefined", Status::invalid_start}};
  for (const auto& [name, status] : expected) {
    const NlFile file = read_nl(nl_path(name));
    Point point = file.start;
    const Result result = make_solver("newton-kkt", *file.problem)->solve(point);
    EXPECT_EQ(result.status, status) << name << ": " << to_string(result.status);
  }
}

/// Where ../shared/nl is: the Hock-Schittkowski problems as AMPL writes them, with the objectives that another solver found.
TEST_F(NlSolves, TheHockSchittkowskiFilesReachTheirReference) {
  const std::filesystem::path folder = std::filesystem::path(TENON_SOURCE_DIR) / "../shared/nl";
  if (!std::filesystem::exists(folder / "reference.csv")) GTEST_SKIP() << folder << " is not there";
  const CsvTable reference = read_csv((folder / "reference.csv").string(), {{"objective", "n", "m"}, {}});
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".nl") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  ASSERT_EQ(static_cast<int>(names.size()), reference.rows());
  int worse = 0;
  for (std::size_t k = 0; k < names.size(); ++k) {
    const NlFile file = read_nl((folder / (names[k] + ".nl")).string());
    Point point = file.start;
    const Result result = make_solver("newton-kkt", *file.problem)->solve(point);
    const double best = reference["objective"][k];
    if (names[k] == "hs013") {  // has no KKT point: the nearer to its minimum, the worse the multipliers; the reference is a little infeasible
      EXPECT_NEAR(result.objective, 1, 1e-3);
      EXPECT_LT(result.iterations, 100);  // the loop sees that there is nothing to converge to
      EXPECT_LE(result.residual.primal, 1e-8);
      continue;
    }
    EXPECT_EQ(result.status, Status::solved) << names[k];
    EXPECT_LE(result.scaled_residual.value_or(result.residual).max_scaled(), 1e-8) << names[k];
    if (result.objective > best + 1e-6 * std::max(1.0, std::abs(best))) ++worse;
  }
  EXPECT_LE(worse, 1);  // hs097 has several minima, and 4.0712 is not the lowest
}

}  // namespace
}  // namespace tenon
