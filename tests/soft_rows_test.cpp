// Soft rows: an exact penalty changes nothing while its weight exceeds the multiplier; else the rows give way at the least price, and no
// multiplier exceeds what a violation costs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "small_problems.hpp"
#include "tenon/core/check_derivatives.hpp"
#include "tenon/core/with_soft_rows.hpp"
#include "tenon/problems/catalogue.hpp"
#include "tenon/solvers/make_solver.hpp"
#include "tenon/tests/solved.hpp"

namespace tenon {
namespace {

/// A problem some of whose rows are declared soft.
class Softened final : public NlpDecorator {
 public:
  Softened(const Nlp& problem, std::vector<SoftRow> soft) : NlpDecorator(problem), soft_(std::move(soft)) {}
  std::vector<SoftRow> soft_rows() const override { return soft_; }

 private:
  std::vector<SoftRow> soft_;
};

std::vector<SoftRow> all_rows(const Nlp& problem, double linear, double quadratic = 0) {
  std::vector<SoftRow> soft;
  for (int j = 0; j < problem.num_constraints(); ++j) soft.push_back({j, linear, quadratic});
  return soft;
}

bool is_available(const std::string& name) {
  const auto all = list_solvers();
  return std::ranges::any_of(all, [&](const auto& solver) { return solver.name == name && solver.available; });
}

TEST(SoftRows, TheirSlacksObeyTheDerivativeLaw) {
  const auto problem = find_problem("hs071").make();
  const Softened soft(*problem, all_rows(*problem, 3, 0.7));
  const WithSoftRows slacked(soft);
  EXPECT_EQ(slacked.num_variables(), 8);
  EXPECT_EQ(slacked.variable_name(4), "excess of c[0]");
  EXPECT_EQ(slacked.variable_name(7), "shortfall of c[1]");
  EXPECT_TRUE(check_derivatives(slacked, vector({1, 5, 4, 2, 0.1, 0.2, 0.3, 0.4}), 0.8, vector({1.3, -0.4})).passed(1e-6));
}

TEST(SoftRows, AWeightAboveTheMultiplierRecoversTheHardSolution) {
  for (const CatalogueEntry& entry : catalogue()) {
    const auto problem = entry.make();
    if (problem->num_constraints() == 0) continue;
    const Solved hard = solve(*problem);
    const Softened soft(*problem, all_rows(*problem, 2 * hard.point.lambda.lpNorm<Eigen::Infinity>() + 1));
    const Solved solved = solve(soft);
    EXPECT_EQ(solved.result.status, Status::solved) << entry.name;
    if (entry.name == "hs044" || entry.name == "peg-in-hole") continue;  // several local optima
    EXPECT_NEAR(solved.result.objective, hard.result.objective, 1e-6 * std::max(1.0, std::abs(hard.result.objective))) << entry.name;
    EXPECT_LE(kkt_residual(*problem, solved.point).primal, 1e-6) << entry.name << ": nothing gives way";
  }
}

TEST(SoftRows, EveryBackEndGivesTheSameAnswer) {
  for (const std::string solver : {"newton-kkt", "ipopt", "nlopt-slsqp"}) {
    if (!is_available(solver)) continue;
    const auto problem = find_problem("hs071").make();
    const Solved solved = solve(Softened(*problem, all_rows(*problem, 2)), solver);
    EXPECT_TRUE(succeeded(solved.result.status)) << solver;
    EXPECT_NEAR(solved.point.lambda[0], -0.5522937, 1e-6) << solver;
    EXPECT_NEAR(solved.result.objective, 17.0140173, 1e-6) << solver;
  }
}

TEST(SoftRows, AWeightBelowTheMultiplierIsTheMultiplier) {
  // min x^2  s.t.  x >= 2, softly: lambda* = -4. With w = 1 and q: 2 x = w + q (2 - x)
  const auto x = polynomial_variables(1);
  const PolynomialNlp problem({.name = "step", .start = vector({5}), .objective = square(x[0]), .rows = {at_least_zero(x[0] - 2)}});
  for (const double q : {0.0, 0.5, 3.0}) {
    const Solved solved = solve(Softened(problem, {{.row = 0, .linear = 1, .quadratic = q}}));
    EXPECT_EQ(solved.result.status, Status::solved);
    const double expected = (1 + 2 * q) / (2 + q);
    EXPECT_NEAR(solved.point.x[0], expected, 1e-6);
    EXPECT_NEAR(solved.point.lambda[0], -(1 + q * (2 - expected)), 1e-6);
    EXPECT_NEAR(solved.result.objective, expected * expected, 1e-6) << "without the price";
  }
}

TEST(SoftRows, OfRowsThatContradictTheCheapestGivesWayAndTheOthersAreMet) {
  // x >= 3 (weight 5), x <= 1 (weight 2), x = 2 (weight 1): the weighted sum of violations is least at x = 3
  const auto x = polynomial_variables(1);
  const PolynomialNlp problem(
      {.name = "opposed", .start = vector({0}), .rows = {at_least_zero(x[0] - 3), at_least_zero(1 - x[0]), equals_zero(x[0] - 2)}});
  const Solved solved = solve(Softened(problem, {{0, 5}, {1, 2}, {2, 1}}));
  EXPECT_EQ(solved.result.status, Status::solved);
  EXPECT_NEAR(solved.point.x[0], 3, 1e-6);
  EXPECT_NEAR(solved.point.lambda[1], -2, 1e-6);
  EXPECT_NEAR(solved.point.lambda[2], 1, 1e-6);
  EXPECT_NEAR(solved.point.lambda[0], -3, 1e-6) << "it balances the two that give way, below its price of 5";
}

TEST(SoftRows, AHardRowBesideThemStaysHard) {
  const auto x = polynomial_variables(2);
  const PolynomialNlp two({.name = "two",
                           .start = vector({1, 2}),
                           .objective = x[0] + x[1],  // x0^2 + x1^2 <= -1 can be met nowhere
                           .rows = {at_least_zero(-1 - square(x[0]) - square(x[1])), at_least_zero(x[0] - 0.25)}});
  const Solved solved = solve(Softened(two, {{.row = 0, .linear = 10}}));
  EXPECT_EQ(solved.result.status, Status::solved);
  EXPECT_NEAR(solved.point.x[0], 0.25, 1e-6);
  EXPECT_NEAR(solved.point.x[1], -0.05, 1e-6) << "1 + 10 (2 x1) = 0";
}

TEST(SoftRows, AWarmStartFromTheAnswerTakesFewIterations) {
  const auto problem = find_problem("hs113").make();
  const Softened soft(*problem, all_rows(*problem, 0.5));
  Solved solved = solve(soft);
  ASSERT_EQ(solved.result.status, Status::solved);
  const Result again = make_solver("newton-kkt", soft, {.warm_start = true})->solve(solved.point);
  EXPECT_EQ(again.status, Status::solved);
  EXPECT_LE(again.iterations, 3);
}

TEST(SoftRows, WeightsThatMakeNoSenseAreErrorsThatNameTheRow) {
  const auto problem = find_problem("hs071").make();
  const auto message = [&](std::vector<SoftRow> rows) -> std::string {
    try {
      make_solver("newton-kkt", Softened(*problem, std::move(rows)));
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "no exception";
  };
  EXPECT_THAT(message({{.row = 1, .linear = -1}}), testing::HasSubstr("soft row c[1] has the weights -1"));
  EXPECT_THAT(message({{.row = 1, .linear = 0}}), testing::HasSubstr("not both 0"));
  EXPECT_THAT(message({{.row = 7, .linear = 1}}), testing::HasSubstr("does not exist (expected 0 to 1)"));
  EXPECT_THAT(message({{.row = 0, .linear = 1}, {.row = 0, .linear = 2}}), testing::HasSubstr("twice"));
}

}  // namespace
}  // namespace tenon
