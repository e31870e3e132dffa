// Laws over the whole catalogue: derivatives against differences, and every available solver against every problem it can take.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>

#include "tenon/core/check_derivatives.hpp"
#include "tenon/problems/catalogue.hpp"
#include "tenon/solvers/make_solver.hpp"

namespace tenon {
namespace {

std::string identifier(std::string name) {
  for (char& c : name) {
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  }
  return name;
}

std::vector<std::string> problem_names() {
  std::vector<std::string> names;
  for (const CatalogueEntry& entry : catalogue()) names.push_back(entry.name);
  return names;
}

std::vector<std::string> available_solvers() {
  std::vector<std::string> names;
  for (const SolverDescription& solver : list_solvers()) {
    if (solver.available) names.push_back(solver.name);
  }
  return names;
}

bool has_equalities(const Nlp& problem) {
  Bounds bounds(problem.num_variables(), problem.num_constraints());
  problem.bounds(bounds);
  return (bounds.c_lower.array() == bounds.c_upper.array()).any();
}

class EveryProblem : public testing::TestWithParam<std::string> {};

TEST_P(EveryProblem, ObeysTheDerivativeLawAtRandomPoints) {
  const auto problem = find_problem(GetParam()).make();
  const int n = problem->num_variables(), m = problem->num_constraints();
  std::mt19937 random(1981);
  std::normal_distribution<double> normal;
  Vector start(n);
  problem->initial_point(start);
  for (int repetition = 0; repetition < 10; ++repetition) {
    const Vector step = Vector::NullaryExpr(n, [&](auto) { return 0.3 * normal(random); });
    const Vector x = start + step.cwiseProduct(start.cwiseAbs().cwiseMax(1));
    const Vector lambda = Vector::NullaryExpr(m, [&](auto) { return normal(random); });
    const DerivativeReport report = check_derivatives(*problem, x, normal(random), lambda);
    ASSERT_TRUE(report.finite);
    for (const DerivativeError& e : report.worst) {
      ADD_FAILURE() << e.what << " of " << e.row << " by " << e.variable << ": " << e.analytic << ", by differences " << e.difference;
    }
  }
}

TEST_P(EveryProblem, StatesBoundsThatMakeSenseAndPatternsThatFit) {
  const auto problem = find_problem(GetParam()).make();
  const int n = problem->num_variables(), m = problem->num_constraints();
  Bounds bounds(n, m);
  problem->bounds(bounds);
  EXPECT_NO_THROW(validate(*problem, bounds));
  EXPECT_EQ(problem->jacobian_pattern().rows, m);
  EXPECT_EQ(problem->jacobian_pattern().cols, n);
  const SparsePattern hessian = problem->hessian_pattern();
  for (int j = 0; j < n; ++j) {
    for (int k = hessian.outer[static_cast<std::size_t>(j)]; k < hessian.outer[static_cast<std::size_t>(j) + 1]; ++k) {
      EXPECT_GE(hessian.inner[static_cast<std::size_t>(k)], j) << "an entry above the diagonal";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Catalogue, EveryProblem, testing::ValuesIn(problem_names()), [](const auto& p) { return identifier(p.param); });

/// What is asked of a solver: success with the published objective, unless a problem is beyond it.
struct Demand {
  double objective_error = 1e-6;         // relative
  bool success = true;                   // solved or acceptable
  std::set<std::string> beyond = {};     // with the reason beside each
};

Demand demand_on(const std::string& solver) {
  // Dense or first-order methods: hundreds of variables tied by dynamics take them minutes.
  static const std::set<std::string> kDynamics = {"cart-pole", "lq", "peg-in-hole", "pendulum"};
  static const std::map<std::string, Demand> weaker = {
      {"nlopt-slsqp", {.beyond = kDynamics}},
      // First-order methods without curvature: they creep, so their own verdict is not asked for, only a near objective.
      {"nlopt-mma", {.objective_error = 1e-4, .success = false, .beyond = {"hs106" /* its rows differ by 1e6 in scale */}}},
      {"nlopt-ccsaq", {.objective_error = 1e-4, .success = false, .beyond = {"hs106" /* its rows differ by 1e6 in scale */}}},
      // One penalty for all rows: it falls into the origin of hs093, where the product of degree six is flat, and cannot scale hs106.
      {"nlopt-auglag", {.objective_error = 1e-4, .success = false, .beyond = {"hs093", "hs106", "cart-pole", "lq", "peg-in-hole", "pendulum"}}},
  };
  const auto found = weaker.find(solver);
  return found == weaker.end() ? Demand{} : found->second;
}

/// Known local minima beside the published one.
std::vector<double> known_minima(const CatalogueEntry& entry) {
  static const std::map<std::string, std::vector<double>> others = {{"hs044", {-13}}, {"cart-pole", {11190.6966}}};
  std::vector<double> all = {*entry.published_objective};
  if (const auto found = others.find(entry.name); found != others.end()) all.insert(all.end(), found->second.begin(), found->second.end());
  return all;
}

class EverySolver : public testing::TestWithParam<std::tuple<std::string, std::string>> {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(EverySolver);

TEST_P(EverySolver, ReachesThePublishedObjective) {
  const auto& [solver_name, problem_name] = GetParam();
  const CatalogueEntry& entry = find_problem(problem_name);
  const auto problem = entry.make();
  const Demand demand = demand_on(solver_name);
  if (demand.beyond.contains(problem_name)) GTEST_SKIP() << "beyond " << solver_name;
  if ((solver_name == "nlopt-mma" || solver_name == "nlopt-ccsaq") && has_equalities(*problem)) {
    EXPECT_THROW(make_solver(solver_name, *problem), std::invalid_argument);
    return;
  }

  Point point(problem->num_variables(), problem->num_constraints());
  problem->initial_point(point.x);
  const Result result = make_solver(solver_name, *problem)->solve(point);

  if (demand.success) {
    EXPECT_TRUE(succeeded(result.status)) << to_string(result.status) << ", residual " << result.residual.max_scaled();
  }
  if (result.status == Status::solved) {
    EXPECT_LE(result.residual.max_scaled(), Options().tolerance);
  }
  EXPECT_EQ(result.residual.max_scaled(), kkt_residual(*problem, point).max_scaled());
  if (!entry.published_objective) return;
  double nearest = kInfinity<double>;
  for (const double minimum : known_minima(entry)) {
    nearest = std::min(nearest, std::abs(result.objective - minimum) / std::max(1.0, std::abs(minimum)));
  }
  EXPECT_LE(nearest, demand.objective_error) << "objective " << result.objective << ", published " << *entry.published_objective;
}

INSTANTIATE_TEST_SUITE_P(Catalogue, EverySolver,
                         testing::Combine(testing::ValuesIn(available_solvers()), testing::ValuesIn(problem_names())),
                         [](const auto& p) { return identifier(std::get<0>(p.param) + "_" + std::get<1>(p.param)); });

TEST(Catalogue, IsSortedByName) {
  EXPECT_TRUE(std::ranges::is_sorted(catalogue(), {}, &CatalogueEntry::name));
}

TEST(Catalogue, AnUnknownProblemIsAnErrorThatNamesTheNearest) {
  try {
    find_problem("hs0711");
    FAIL() << "no exception";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("\"hs071\""), std::string::npos) << error.what();
  }
}

TEST(Classic, TheObjectiveAtThePublishedStartIsTheKnownOne) {
  // A slip in a formula that leaves the optimum alone shows here.
  const std::map<std::string, double> known = {
      {"hs001", 909},     {"hs012", 0},  {"hs028", 13},    {"hs035", 2.25},       {"hs039", -2},
      {"hs040", -0.4096}, {"hs043", 0},  {"hs044", 0},     {"hs065", 1225.0 / 9}, {"hs071", 16},
      {"hs076", -1.25},   {"hs100", 714}, {"hs106", 15000}, {"hs113", 753},        {"hs093", 137.066437},
  };
  for (const auto& [name, objective] : known) {
    const auto problem = find_problem(name).make();
    Vector x(problem->num_variables());
    problem->initial_point(x);
    Nlp::Workspace workspace = problem->make_workspace();
    problem->prepare(x, workspace);
    EXPECT_NEAR(problem->objective(x, workspace), objective, 1e-5 * std::max(1.0, std::abs(objective))) << name;
  }
}

}  // namespace
}  // namespace tenon
