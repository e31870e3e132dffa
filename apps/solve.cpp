// tenon solve PROBLEM: one nonlinear program, from its own starting point.
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "tenon/apps/interrupt.hpp"
#include "tenon/apps/make_report.hpp"
#include "tenon/apps/next_step.hpp"
#include "tenon/apps/observers.hpp"
#include "tenon/apps/result_json.hpp"
#include "tenon/apps/table.hpp"
#include "tenon/apps/verb.hpp"
#include "tenon/problems/catalogue.hpp"
#include "tenon/solvers/make_solver.hpp"

namespace tenon {

namespace {

constexpr int kVariablesShown = 20;

/// The first back end that is there: tenon's own comes first in the list.
std::string default_solver() {
  for (const SolverDescription& s : list_solvers()) {
    if (s.available) return s.name;
  }
  throw std::invalid_argument("no solver is available (expected a build with at least one back end)");
}

void print_result(const Nlp& problem, const CatalogueEntry& entry, const Measurement& m, double tolerance) {
  const Result& result = m.result;
  const auto line = [](const char* what, const std::string& value) { fmt::print("  {:<14}{}\n", what, value); };
  fmt::print("{} by {}: {}\n", entry.name, m.solver, to_string(result.status));
  line("objective", fmt::format("{:.12g}", result.objective));
  if (entry.published_objective) line("published", fmt::format("{:.12g}", *entry.published_objective));
  line("iterations", fmt::format("{}", result.iterations));
  line("residual", fmt::format("stationarity {:.2e}, primal {:.2e}, complementarity {:.2e}", result.residual.stationarity,
                               result.residual.primal, result.residual.complementarity));
  line("evaluations", fmt::format("{} objective, {} gradient, {} constraints, {} Jacobian, {} Hessian", m.counts.objective,
                                  m.counts.gradient, m.counts.constraints, m.counts.jacobian, m.counts.hessian));
  line("time", duration_text(m.time));
  if (result.status == Status::infeasible) {
    for (const Violation& v : violations(problem, m.point.x, tolerance)) {
      line("violated", fmt::format("{} = {:.6g}, not in [{}, {}]", v.name, v.value, v.lower, v.upper));
    }
  }
  Table table({"", "variable", "value", "multiplier"});
  const int shown = std::min(problem.num_variables(), kVariablesShown);
  for (int i = 0; i < shown; ++i) {
    table.add({"", problem.variable_name(i), fmt::format("{:.12g}", m.point.x[i]), fmt::format("{:.3e}", m.point.z[i])});
  }
  fmt::print("{}", table.text());
  if (shown < problem.num_variables()) fmt::print("  and {} more: see --json\n", problem.num_variables() - shown);
  if (!next_step(result.status).empty()) line("next", std::string(next_step(result.status)));
}

}  // namespace

int run_solve(const Arguments& given) {
  Arguments arguments = given;
  check_report(arguments);
  if (arguments.trace.empty()) arguments.trace = record_beside_report(arguments, ".jsonl", "");  // the page is made from it
  const CatalogueEntry& entry = find_problem(arguments.names.front());
  const std::unique_ptr<Nlp> problem = entry.make();
  Options options = arguments.options();
  Observers observers(arguments);
  options.on_iteration = observers.callback();
  const Measurement m = measure(*problem, arguments.solver ? *arguments.solver : default_solver(), options, suggested_start(*problem), 0);
  if (!m.refusal.empty()) throw std::invalid_argument(m.refusal);
  observers.finish();
  make_report(arguments, {arguments.trace});
  if (arguments.json)
    print(result_json(*problem, m, options.tolerance));
  else if (!arguments.quiet)
    print_result(*problem, entry, m, options.tolerance);
  if (interrupted()) return kInterrupted;
  return succeeded(m.result.status) ? kFinished : kNotSolved;
}

}  // namespace tenon
