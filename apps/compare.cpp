// tenon compare PROBLEM...: the same problem on every back end, the same start and tolerance, judged by one ruler, the solve alone timed.
#include "tenon/apps/compare.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tenon/apps/comma_list.hpp"
#include "tenon/apps/interrupt.hpp"
#include "tenon/apps/make_report.hpp"
#include "tenon/apps/progress.hpp"
#include "tenon/apps/result_json.hpp"
#include "tenon/apps/table.hpp"
#include "tenon/apps/verb.hpp"
#include "tenon/core/nearest_name.hpp"
#include "tenon/problems/allocation/vehicle_file.hpp"

namespace tenon {

namespace {

constexpr double kUsualTimeLimit = 10;  // s

bool is_vehicle(const std::string& name) {
  const std::vector<std::string> vehicles = builtin_vehicles();
  return std::count(vehicles.begin(), vehicles.end(), name) > 0 || name.ends_with(".toml");
}

std::vector<std::string> table_row(const std::string& problem, const Measurement& m) {
  if (!m.refusal.empty()) return {problem, m.solver, "not taken", "-", "-", "-", "-", "-"};
  const EvaluationCounts& c = m.counts;
  return {problem,
          m.solver,
          std::string(to_string(m.result.status)),
          fmt::format("{:.9g}", m.result.objective),
          fmt::format("{:.1e}", m.result.residual.max()),
          fmt::format("{}", m.result.iterations),
          fmt::format("{}/{}/{}/{}/{}", c.objective, c.gradient, c.constraints, c.jacobian, c.hessian),
          duration_text(m.time)};
}

}  // namespace

std::vector<SolverDescription> chosen_solvers(const Arguments& arguments, const std::vector<SolverDescription>& known) {
  std::vector<SolverDescription> chosen;
  if (!arguments.solvers) {
    std::copy_if(known.begin(), known.end(), std::back_inserter(chosen), [](const SolverDescription& s) { return s.available; });
    return chosen;
  }
  std::vector<std::string> names;
  for (const SolverDescription& s : known) names.push_back(s.name);
  for (const std::string& name : split_list(*arguments.solvers)) {
    const auto at = std::find_if(known.begin(), known.end(), [&](const SolverDescription& s) { return s.name == name; });
    if (at == known.end()) {
      throw std::invalid_argument(fmt::format("unknown solver '{}', the nearest is '{}' (expected one of {})", name,
                                              nearest_name(name, names), fmt::join(names, ", ")));
    }
    if (!at->available)
      throw std::invalid_argument(fmt::format("solver '{}' is not available: its library was absent when this was built", name));
    chosen.push_back(*at);
  }
  return chosen;
}

Options comparison_options(const Arguments& arguments, const Options& of_problem) {
  Options options = arguments.options(of_problem);
  if (!arguments.time_limit) options.time_limit = kUsualTimeLimit;
  return options;
}

Measurement timed(const NamedProblem& named, const std::string& solver, const Options& options) {
  Measurement once = measure(named, solver, options, 0);
  if (!once.refusal.empty() || once.time > kWorthRepeating) return once;
  return measure(named, solver, options, kTimedRuns);
}

std::optional<CsvWriter> comparison_record(const Arguments& arguments) {
  check_report(arguments);
  const std::string path = !arguments.output.empty() ? arguments.output : record_beside_report(arguments, ".csv", "");
  if (path.empty()) return std::nullopt;
  return std::optional<CsvWriter>(std::in_place, path, std::vector<std::string>{"problem", "solver", "status", "objective", "residual", "iterations", "time_s"});
}

void write_comparison(CsvWriter& csv, const std::string& problem, const std::string& solver, std::string_view status, double objective, double residual,
                      int iterations, double time) {
  csv << problem << solver << status;
  for (const double value : {objective, residual}) std::isfinite(value) ? csv << value : csv << "";
  csv << iterations << time;
  csv.end_row();
}

void finish_comparison(CsvWriter& csv, const Arguments& arguments) {
  csv.finish();
  make_report(arguments, {csv.file().path()});
}

Json solvers_json(const std::vector<SolverDescription>& solvers) {
  Json list = Json::array();
  for (const SolverDescription& s : solvers) {
    list.push(Json::object().set("name", s.name).set("description", s.description).set("options", s.options));
  }
  return list;
}

void print_solvers(const std::vector<SolverDescription>& solvers) {
  for (const SolverDescription& s : solvers)
    fmt::print("{}: {}; {}\n", s.name, s.description, s.options.empty() ? "no further options" : s.options);
}

int run_compare(const Arguments& arguments) {
  if (!arguments.profile.empty()) return compare_profile(arguments);
  if (arguments.names.empty()) throw std::invalid_argument("compare: nothing named (expected PROBLEM..., or --profile DIR)");
  if (std::any_of(arguments.names.begin(), arguments.names.end(), is_vehicle)) {
    if (arguments.names.size() > 1) throw std::invalid_argument("compare: a vehicle stands alone (expected one vehicle, or problems)");
    return compare_vehicle(arguments.names.front(), arguments);
  }
  const std::vector<SolverDescription> solvers = chosen_solvers(arguments);
  std::vector<NamedProblem> problems;  // all of them before the first is solved: a name that is wrong shows at once
  for (const std::string& name : arguments.names) problems.push_back(load_problem(name));
  const Options options = comparison_options(arguments, problems.front().options);

  Table table({"problem", "solver", "status", "objective", "residual", "iterations", "evaluations", "time"});
  Json rows = Json::array();
  std::vector<std::string> refusals;
  std::optional<CsvWriter> record = comparison_record(arguments);
  {
    Progress progress("compare", std::ssize(arguments.names) * std::ssize(solvers), arguments.quiet);
    long done = 0;
    for (const NamedProblem& named : problems) {
      for (const SolverDescription& solver : solvers) {
        if (interrupted()) return kInterrupted;
        const Measurement m = timed(named, solver.name, options);
        table.add(table_row(named.name, m));
        if (record && m.refusal.empty()) {
          write_comparison(*record, named.name, solver.name, to_string(m.result.status), m.result.objective, m.result.residual.max(),
                           m.result.iterations, m.time);
        }
        if (!m.refusal.empty()) {
          refusals.push_back(fmt::format("{} on {}: {}", named.name, solver.name, m.refusal));
          rows.push(Json::object().set("problem", named.name).set("solver", solver.name).set("refusal", m.refusal));
        } else {
          Json row = result_json(*named.problem, m);
          if (named.published_objective) row.set("published_objective", *named.published_objective);
          rows.push(row);
        }
        progress.update(++done);
      }
    }
  }
  if (record) finish_comparison(*record, arguments);
  if (arguments.json) {
    print(Json::object()
              .set("schema", 1)
              .set("tolerance", options.tolerance)
              .set("timed_runs", kTimedRuns)
              .set("solvers", solvers_json(solvers))
              .set("results", rows));
    return kFinished;
  }
  fmt::print("{}\n", table.text());
  fmt::print(
      "evaluations: objective/gradient/constraints/Jacobian/Hessian of one solve; residual: the largest of the unscaled KKT residual\n");
  fmt::print("time: the solve alone, median of {} below {} s, at most {:g} s; tolerance {} for all, printing off\n", kTimedRuns, kWorthRepeating,
             options.time_limit, options.tolerance);
  print_solvers(solvers);
  for (const std::string& refusal : refusals) fmt::print("{}\n", refusal);
  return kFinished;
}

}  // namespace tenon
