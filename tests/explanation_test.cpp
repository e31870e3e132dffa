// What a failed solve says: exactly the rows that conflict, the value that is not finite and where, the derivative that is wrong, the row
// that depends on others, what is worst; and no failure is called solved.
#include "tenon/core/explanation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "small_problems.hpp"
#include "tenon/core/dependent_rows.hpp"
#include "tenon/core/nlp_decorator.hpp"
#include "tenon/core/nonnegative_least_squares.hpp"
#include "tenon/problems/catalogue.hpp"
#include "tenon/problems/optimal_control/swing_up.hpp"
#include "tenon/solvers/make_solver.hpp"

namespace tenon {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::UnorderedElementsAre;

struct Ended {
  Point point;
  Result result;
  Explanation explanation;

  std::vector<std::string> names() const {
    std::vector<std::string> list;
    for (const Limit& limit : explanation.conflict) list.push_back(limit.name);
    return list;
  }
};

Ended solve(const Nlp& problem, const Options& options = {}, const std::string& solver = "newton-kkt") {
  Ended out{Point(problem.num_variables(), problem.num_constraints()), {}, {}};
  problem.initial_point(out.point.x);
  out.result = make_solver(solver, problem, options)->solve(out.point);
  out.explanation = explain(problem, out.point, out.result);
  return out;
}

Result ended_with(Status status) {
  Result result;
  result.status = status;
  return result;
}

/// Fifty rows over twenty variables, met with room at x = 1 whatever the seed, but for three that ask x0 + x1 >= 3, x1 - x2 <= 1 and
/// x0 + x2 <= 1.5 of the same point: their sum reads 3 <= 2.5.
PolynomialNlp planted(unsigned seed, bool curved) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> coefficient(-1, 1);
  const auto x = polynomial_variables(20);
  PolynomialProgram program{.name = "planted", .start = Vector::Zero(20)};
  for (int i = 0; i < 20; ++i) program.objective += square(x[std::size_t(i)] - coefficient(random));
  for (int j = 0; j < 50; ++j) {
    if (j == 7)
      program.rows.push_back(at_least_zero(x[0] + x[1] - 3));
    else if (j == 23)
      program.rows.push_back(at_least_zero(1 - x[1] + x[2]));
    else if (j == 41)
      program.rows.push_back(at_least_zero(1.5 - x[0] - x[2]));
    else {
      Polynomial row;
      for (int k = 0; k < 4; ++k) {
        const Polynomial& v = x[random() % 20];
        row += coefficient(random) * (curved ? v * x[random() % 20] : v);
      }
      const double at_one = row(Vector::Ones(20));
      program.rows.push_back({row, at_one - 30, at_one + 30});
    }
  }
  return PolynomialNlp(program);
}

TEST(Explanation, OfThreeRowsInConflictAmongFiftyExactlyThoseAreNamed) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    for (const bool curved : {false, true}) {
      const Ended ended = solve(planted(seed, curved));
      EXPECT_EQ(ended.result.status, Status::infeasible) << seed << curved;
      EXPECT_THAT(ended.names(), UnorderedElementsAre("c[7]", "c[23]", "c[41]")) << seed << curved << ended.explanation.text();
      double violation = 0;
      for (const Limit& limit : ended.explanation.conflict) violation += limit.violation;
      EXPECT_NEAR(violation, 0.5, 1e-5) << "the sum of the three rows misses by one half";
    }
  }
}

TEST(Explanation, TheConflictIsNamedWhicheverBackEndEndedThere) {
  for (const std::string solver : {"ipopt", "nlopt-slsqp"}) {
    for (const SolverDescription& known : list_solvers()) {
      if (known.name == solver && !known.available) GTEST_SKIP();
    }
    const Ended ended = solve(planted(3, false), {}, solver);
    EXPECT_FALSE(succeeded(ended.result.status));
    if (ended.result.status == Status::infeasible) {
      EXPECT_THAT(ended.names(), UnorderedElementsAre("c[7]", "c[23]", "c[41]")) << solver;
    }
  }
}

TEST(Explanation, BoundsThatTakePartInAConflictAreNamedWithTheirSide) {
  // x0 + x1 <= -1 against x0 >= 0 and x1 >= 0; x2 has nothing to do with it
  const auto x = polynomial_variables(3);
  const PolynomialNlp problem({.name = "bounds",
                               .start = Vector::Ones(3),
                               .x_lower = Vector::Zero(3),
                               .objective = square(x[2]),
                               .rows = {at_least_zero(-1 - x[0] - x[1]), at_least_zero(x[2] + 5)}});
  const Ended ended = solve(problem);
  EXPECT_EQ(ended.result.status, Status::infeasible);
  ASSERT_THAT(ended.names(), UnorderedElementsAre("c[0]", "x[0]", "x[1]"));
  for (const Limit& limit : ended.explanation.conflict) {
    EXPECT_EQ(limit.is_bound, limit.name != "c[0]");
    EXPECT_NEAR(limit.multiplier, -1, 1e-6) << "each pushes at its lower side, with the same weight: " << limit.name;
  }
}

TEST(Explanation, ARowThatCanBeMetNowhereStandsAlone) {
  const Ended ended = solve(infeasible());
  EXPECT_EQ(ended.result.status, Status::infeasible);
  EXPECT_THAT(ended.names(), UnorderedElementsAre("c[0]"));
  EXPECT_THAT(ended.explanation.text(), HasSubstr("this cannot be met"));
}

TEST(Explanation, ASoftOrCompliantRowIsNoPartOfAConflict) {
  class Soft final : public NlpDecorator {
   public:
    using NlpDecorator::NlpDecorator;
    std::vector<SoftRow> soft_rows() const override { return {{.row = 7, .linear = 1}}; }
  };
  const PolynomialNlp problem = planted(1, false);
  const Ended hard = solve(problem);
  EXPECT_THAT(conflict(problem, hard.point.x), testing::SizeIs(3));
  EXPECT_THAT(conflict(Soft(problem), hard.point.x), IsEmpty());
}

TEST(Explanation, AValueThatIsNotFiniteIsNamedWithItsPoint) {
  const Ended ended = solve(Logarithm(-1));
  EXPECT_EQ(ended.result.status, Status::invalid_start);
  EXPECT_THAT(ended.explanation.text(), HasSubstr("the objective is nan at x[0] = -1"));

  class RootRow final : public NlpDecorator {
   public:
    using NlpDecorator::NlpDecorator;
    void constraints(ConstVectorRef x, Workspace& w, VectorRef values) const override {
      problem_.constraints(x, w, values);
      values[1] = std::sqrt(-1 - x[0] * x[0]);
    }
    std::string constraint_name(int j) const override { return j == 1 ? "root" : NlpDecorator::constraint_name(j); }
  };
  const auto hs071 = find_problem("hs071").make();
  const Ended row = solve(RootRow(*hs071));
  EXPECT_EQ(row.result.status, Status::invalid_start);
  EXPECT_THAT(row.explanation.text(), HasSubstr("row root is"));
  EXPECT_THAT(row.explanation.text(), HasSubstr("x[3] = "));
}

/// hs043, whose derivatives are finite at the start (0, 0, 0, 0) but not where x[1] > edge; its solution is (0, 1, 2, -1).
class SpoiltBeyond final : public NlpDecorator {
 public:
  enum What { gradient_by_x2, row_1_by_x0 };
  SpoiltBeyond(const Nlp& problem, What what, double edge) : NlpDecorator(problem), what_(what), edge_(edge) {}

  void gradient(ConstVectorRef x, Workspace& w, VectorRef gradient) const override {
    problem_.gradient(x, w, gradient);
    if (what_ == gradient_by_x2 && x[1] > edge_) gradient[2] = std::nan("");
  }
  void jacobian(ConstVectorRef x, Workspace& w, std::span<double> values) const override {
    problem_.jacobian(x, w, values);
    if (what_ == row_1_by_x0 && x[1] > edge_) values[1] = std::nan("");
  }

 private:
  What what_;
  double edge_;
};

TEST(Explanation, ADerivativeThatIsNotFiniteAtTheStartIsNamedScaledOrNot) {
  const auto hs043 = find_problem("hs043").make();
  for (const bool scaling : {true, false}) {
    for (const auto& [what, name] : {std::pair{SpoiltBeyond::gradient_by_x2, "the objective's derivative by x[2] is nan"},
                                     std::pair{SpoiltBeyond::row_1_by_x0, "the derivative of row c[1] by x[0] is nan"}}) {
      const Ended ended = solve(SpoiltBeyond(*hs043, what, -1), {.scaling = scaling});
      EXPECT_EQ(ended.result.status, Status::invalid_start);
      EXPECT_THAT(ended.explanation.text(), HasSubstr(name));
    }
  }
}

TEST(Explanation, DerivativesThatAreNotFiniteLaterOnAreNoConflictOfRows) {
  const auto hs043 = find_problem("hs043").make();
  for (const bool scaling : {true, false}) {
    for (const auto what : {SpoiltBeyond::gradient_by_x2, SpoiltBeyond::row_1_by_x0}) {
      for (int step = 1; step < 20; ++step) {
        const SpoiltBeyond problem(*hs043, what, 0.05 * step);
        const Ended ended = solve(problem, {.scaling = scaling});
        EXPECT_EQ(ended.result.status, Status::numerical_failure) << scaling << what << " " << step;
        EXPECT_THAT(ended.names(), IsEmpty());
        EXPECT_FALSE(ended.explanation.sentences.empty());
      }
    }
  }
}

TEST(Explanation, AWrongDerivativeIsNamed) {
  class WrongJacobian final : public NlpDecorator {
   public:
    using NlpDecorator::NlpDecorator;
    void jacobian(ConstVectorRef x, Workspace& w, std::span<double> values) const override {
      problem_.jacobian(x, w, values);
      values[3] = -values[3];  // row 1 by x[1]
    }
  };
  const auto hs071 = find_problem("hs071").make();
  const WrongJacobian problem(*hs071);
  Ended ended = solve(problem, {.max_iterations = 20});
  ended.explanation = explain(problem, ended.point, ended_with(Status::iteration_limit));
  EXPECT_THAT(ended.explanation.text(), HasSubstr("the jacobian of c[1] by x[1] is"));
}

TEST(Explanation, ARowThatDependsOnOthersIsNamedWithThem) {
  const auto x = polynomial_variables(4);
  const PolynomialNlp problem({.name = "dependent",
                               .start = Vector::Ones(4),
                               .objective = square(x[0]) + square(x[1] - 2) + square(x[2]) + square(x[3]),
                               .rows = {equals_zero(x[0] + x[1] - 2), equals_zero(x[2] - x[3]), equals_zero(x[1] * x[2] - 1),
                                        equals_zero(x[0] + x[1] + 2 * x[2] - 2 * x[3] - 2)}});
  const std::vector<DependentRow> found = dependent_rows(problem, vector({1, 1, 1, 1}));
  ASSERT_EQ(found.size(), 1u);
  std::vector<int> all = found[0].on;
  all.push_back(found[0].row);
  EXPECT_THAT(all, UnorderedElementsAre(0, 1, 3)) << "row 2 has nothing to do with it";
  EXPECT_THAT(solve(problem, {.max_iterations = 0}).explanation.text(), HasSubstr("depends on that of c["));
  EXPECT_TRUE(succeeded(solve(problem).result.status)) << "which is no reason not to solve it";
}

TEST(Explanation, ARowWithoutAGradientIsNamed) {
  const auto x = polynomial_variables(2);
  const PolynomialNlp problem(
      {.name = "flat", .start = vector({0, 0}), .objective = x[0] + x[1], .rows = {equals_zero(square(x[0]) + square(x[1]))}});
  const Ended ended = solve(problem);
  EXPECT_THAT(explain(problem, Point(2, 1), ended_with(Status::numerical_failure)).text(), HasSubstr("gradient of row c[0] is 0"));
  EXPECT_TRUE(ended.result.status != Status::solved || ended.result.residual.max_scaled() <= 1e-8);
}

TEST(Explanation, AnEarlyEndSaysWhatIsWorstAndWhetherItIsActive) {
  const Ended ended = solve(*find_problem("hs071").make(), {.max_iterations = 2});
  EXPECT_EQ(ended.result.status, Status::iteration_limit);
  EXPECT_THAT(ended.explanation.text(), HasSubstr("stationarity is worst"));
  EXPECT_THAT(ended.explanation.text(), HasSubstr("complementarity is worst"));
  EXPECT_THAT(ended.explanation.text(), testing::Not(HasSubstr("differences say")));
}

TEST(Explanation, AnUnboundedEndNamesWhatRanAway) {
  const Ended ended = solve(unbounded());
  EXPECT_EQ(ended.result.status, Status::unbounded);
  EXPECT_THAT(ended.explanation.text(), HasSubstr("has run furthest"));
}

TEST(Explanation, AMinimumWithoutMultipliersIsSaidToBeOne) {
  const auto x = polynomial_variables(2);  // hs013: the gradients of the two active rows at (1, 0) are opposite
  const Polynomial depth = 1 - x[0];
  const PolynomialNlp problem({.name = "cusp",
                               .start = vector({-2, -2}),
                               .x_lower = vector({0, 0}),
                               .objective = square(x[0] - 2) + square(x[1]),
                               .rows = {at_least_zero(depth * depth * depth - x[1])}});
  Point point(2, 1);
  point.x << 1, 0;
  Result result = ended_with(Status::numerical_failure);
  EXPECT_THAT(explain(problem, point, result).text(), Not(HasSubstr("without limit")));
  result.residual.scale = 1e7;
  EXPECT_THAT(explain(problem, point, result).text(), HasSubstr("multipliers grow without limit"));
}

TEST(Explanation, OfAProblemWithStagesNamesThem) {
  const SwingUp problem(cart_pole(20));
  EXPECT_THAT(solve(problem, {.max_iterations = 3}).explanation.text(), HasSubstr(" (stage "));
}

TEST(Explanation, ASolvedProblemNeedsNone) {
  EXPECT_THAT(solve(*find_problem("hs071").make()).explanation.sentences, IsEmpty());
}

TEST(NonnegativeLeastSquares, ItsAnswerIsStationaryOnRandomProblems) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (int round = 0; round < 50; ++round) {
    const int rows = 1 + int(random() % 12), cols = 1 + int(random() % 20);
    Eigen::MatrixXd A(rows, cols);
    Vector b(rows);
    for (double& a : A.reshaped()) a = normal(random);
    for (double& v : b) v = normal(random);
    const Vector y = nonnegative_least_squares(A, b), slope = A.transpose() * (b - A * y);
    for (int k = 0; k < cols; ++k) {
      EXPECT_GE(y[k], 0);
      EXPECT_LE(slope[k], 1e-9);
      EXPECT_LE(std::abs(y[k] * slope[k]), 1e-9);
    }
  }
}

}  // namespace
}  // namespace tenon
