#include "tenon/solvers/make_solver.hpp"

#include <algorithm>
#include <iterator>
#include <stdexcept>

#include "tenon/core/nearest_name.hpp"
#include "tenon/core/with_slacks.hpp"
#include "tenon/core/with_soft_rows.hpp"
#include "tenon/solvers/ipopt.hpp"
#include "tenon/solvers/newton_kkt/make_newton_kkt.hpp"
#include "tenon/solvers/nlopt.hpp"

namespace tenon {

namespace {

struct BackEnd {
  SolverDescription (*describe)();
  std::unique_ptr<Solver> (*make)(const Nlp&, const Options&);
  bool takes_compliant_rows;  // false: they get slacks
};

constexpr BackEnd kBackEnds[] = {
    {describe_newton_kkt, make_newton_kkt, true},
    {describe_ipopt, make_ipopt, false},
    {describe_nlopt_slsqp, make_nlopt_slsqp, false},
    {describe_nlopt_mma, make_nlopt_mma, false},
    {describe_nlopt_ccsaq, make_nlopt_ccsaq, false},
    {describe_nlopt_auglag, make_nlopt_auglag, false},
};

/// A back end that knows hard rows only, for a problem with compliant ones.
class SlackedSolver final : public Solver {
 public:
  SlackedSolver(const Nlp& problem, const BackEnd& back_end, const Options& options)
      : problem_(problem), slacked_(problem), inner_(back_end.make(slacked_, options)) {}

  Result solve(Point& point) override {
    validate(problem_, point);
    slacked_.update();
    Point lifted = slacked_.lift(point);
    Result result = inner_->solve(lifted);
    slacked_.lower(lifted, point);

    // The answer is that of the problem itself: its own objective without the price of the slacks, its own residual.
    Nlp::Workspace workspace = problem_.make_workspace();
    problem_.prepare(point.x, workspace);
    result.objective = problem_.objective(point.x, workspace);
    result.residual = kkt_residual(problem_, point);
    return result;
  }

 private:
  const Nlp& problem_;
  WithSlacks slacked_;
  std::unique_ptr<Solver> inner_;
};

/// Any back end for a problem with soft rows. The residual is that of the problem with slacks, where a soft row may be violated at its price.
class SoftSolver final : public Solver {
 public:
  SoftSolver(const std::string& name, const Nlp& problem, const Options& options)
      : problem_(problem), softened_(problem), inner_(make_solver(name, softened_, options)) {}

  Result solve(Point& point) override {
    validate(problem_, point);
    Point lifted = softened_.lift(point);
    Result result = inner_->solve(lifted);
    softened_.lower(lifted, point);
    result.objective -= softened_.price(lifted.x);
    return result;
  }

 private:
  const Nlp& problem_;
  WithSoftRows softened_;
  std::unique_ptr<Solver> inner_;
};

}  // namespace

std::vector<SolverDescription> list_solvers() {
  std::vector<SolverDescription> all;
  for (const BackEnd& back_end : kBackEnds) all.push_back(back_end.describe());
  return all;
}

std::unique_ptr<Solver> make_solver(const std::string& name, const Nlp& problem, const Options& options) {
  const std::vector<SolverDescription> all = list_solvers();
  const auto found = std::ranges::find(all, name, &SolverDescription::name);
  if (found == all.end()) {
    std::vector<std::string> names;
    std::ranges::transform(all, std::back_inserter(names), &SolverDescription::name);
    throw std::invalid_argument("unknown solver \"" + name + "\", did you mean \"" + nearest_name(name, names) + "\"?");
  }
  if (!problem.soft_rows().empty()) return std::make_unique<SoftSolver>(name, problem, options);
  const BackEnd& back_end = kBackEnds[found - all.begin()];
  if (!back_end.takes_compliant_rows && has_compliant_rows(problem)) return std::make_unique<SlackedSolver>(problem, back_end, options);
  return back_end.make(problem, options);
}

}  // namespace tenon
