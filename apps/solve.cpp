// tenon solve PROBLEM: one nonlinear program, from its own starting point, or from many. A failed one can be dumped, see dump.hpp.
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "tenon/apps/default_solver.hpp"
#include "tenon/apps/dump.hpp"
#include "tenon/apps/interrupt.hpp"
#include "tenon/apps/make_report.hpp"
#include "tenon/apps/next_step.hpp"
#include "tenon/apps/observers.hpp"
#include "tenon/apps/result_json.hpp"
#include "tenon/apps/table.hpp"
#include "tenon/apps/verb.hpp"
#include "tenon/core/explanation.hpp"
#include "tenon/core/multi_start.hpp"
#include "tenon/core/output_file.hpp"

namespace tenon {

namespace {

constexpr int kVariablesShown = 20;

/// Tries many starts; the best of them becomes the problem's own.
MultiStart try_starts(NamedProblem& named, const std::string& solver, Options options, const Arguments& arguments) {
  options.on_iteration = [](const Iteration&) { return !interrupted(); };
  MultiStart tried =
      multi_start(*named.problem, *make_solver(solver, *named.problem, options), named.start, arguments.starts, arguments.seed);
  named.start = tried.optima.front().start;
  if (named.maximises) {
    for (Optimum& optimum : tried.optima) optimum.result.objective *= -1;
  }
  return tried;
}

Json starts_json(const MultiStart& tried) {
  Json optima = Json::array();
  for (const Optimum& o : tried.optima) {
    optima.push(Json::object().set("status", to_string(o.result.status)).set("objective", o.result.objective).set("found", o.found));
  }
  return Json::object().set("tried", tried.starts).set("failed", tried.failed).set("optima", optima);
}

void print_starts(const MultiStart& tried) {
  fmt::print("{} starts, {} failed; {} distinct:\n", tried.starts, tried.failed, tried.optima.size());
  for (const Optimum& o : tried.optima)
    fmt::print("  {:<12} objective {:.12g}, found {} times\n", to_string(o.result.status), o.result.objective, o.found);
}

void print_result(const NamedProblem& named, const Measurement& m) {
  const Nlp& problem = *named.problem;
  const Result& result = m.result;
  const auto line = [](const char* what, const std::string& value) { fmt::print("  {:<14}{}\n", what, value); };
  fmt::print("{} by {}: {}\n", named.name, m.solver, to_string(result.status));
  line("objective", fmt::format("{:.12g}", result.objective));
  if (named.published_objective) line("published", fmt::format("{:.12g}", *named.published_objective));
  line("iterations", fmt::format("{}", result.iterations));
  const auto residual_text = [](const KktResidual& r) {
    return fmt::format("stationarity {:.2e}, primal {:.2e}, complementarity {:.2e}", r.stationarity, r.primal, r.complementarity);
  };
  line("residual", residual_text(result.residual));
  if (result.scaled_residual) line("scaled", residual_text(*result.scaled_residual));
  line("evaluations", fmt::format("{} objective, {} gradient, {} constraints, {} Jacobian, {} Hessian", m.counts.objective,
                                  m.counts.gradient, m.counts.constraints, m.counts.jacobian, m.counts.hessian));
  line("time", duration_text(m.time));
  fmt::print("{}", explain(problem, m.point, result).text());
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
  NamedProblem named = load_problem(arguments.names.front());
  Options options = arguments.options(named.options);
  const std::string solver = arguments.solver ? *arguments.solver : default_solver();
  if (!arguments.dump.empty()) check_output_path(arguments.dump);
  Observers observers(arguments);
  std::optional<MultiStart> tried;
  if (arguments.starts > 1) tried = try_starts(named, solver, options, arguments);
  options.on_iteration = observers.callback();
  const Measurement m = measure(named, solver, options, 0);
  if (!m.refusal.empty()) throw std::invalid_argument(m.refusal);
  observers.finish();
  if (!arguments.dump.empty() && !succeeded(m.result.status)) write_dump(arguments.dump, named, options, m);
  make_report(arguments, {arguments.trace});
  if (arguments.json) {
    Json json = result_json(*named.problem, m);
    if (tried) json.set("starts", starts_json(*tried));
    print(json);
  } else if (!arguments.quiet) {
    if (tried) print_starts(*tried);
    print_result(named, m);
  }
  if (interrupted()) return kInterrupted;
  return succeeded(m.result.status) ? kFinished : kNotSolved;
}

}  // namespace tenon
