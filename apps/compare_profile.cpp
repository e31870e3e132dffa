// tenon compare --profile DIR [--output STEM]: every .nl file of a folder on every back end.
//
// Writes STEM.csv (the profiles' curves), STEM.svg (the same as a picture) and STEM_problems.csv (each solve). A solver counts as having
// solved a problem where the ruler says solved or acceptable; which of several local optima it found does not count.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <stdexcept>

#include "tenon/apps/compare.hpp"
#include "tenon/apps/interrupt.hpp"
#include "tenon/apps/make_report.hpp"
#include "tenon/apps/profile_picture.hpp"
#include "tenon/apps/progress.hpp"
#include "tenon/apps/table.hpp"
#include "tenon/apps/verb.hpp"
#include "tenon/core/csv.hpp"

namespace tenon {

namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

std::vector<std::string> nl_files(const std::string& folder) {
  std::error_code error;
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".nl") files.push_back(entry.path().string());
  }
  if (error) throw std::invalid_argument(fmt::format("{}: cannot be read as a folder (expected one with .nl files)", folder));
  if (files.empty()) throw std::invalid_argument(fmt::format("{}: there is no .nl file (expected one or more)", folder));
  std::sort(files.begin(), files.end());
  return files;
}

void write_problem(CsvWriter& table, const NamedProblem& named, const Measurement& m) {
  table << std::filesystem::path(named.name).stem().string() << named.problem->num_variables() << named.problem->num_constraints()
        << m.solver;
  if (m.refusal.empty()) {
    const Result& r = m.result;
    table << to_string(r.status) << r.objective << r.residual.max() << r.residual.max_scaled() << r.iterations << m.time;
  } else {
    table << "not_taken" << "" << "" << "" << "" << "";
  }
  table.end_row();
}

void write_profile(CsvWriter& table, const std::string& cost, const PerformanceProfile& profile) {
  for (std::size_t k = 0; k < profile.ratios.size(); ++k) {
    table << cost << profile.ratios[k];
    for (const auto& shares : profile.shares) table << shares[k];
    table.end_row();
  }
}

void write_picture(const std::string& path, const std::string& title, const std::vector<ProfilePanel>& panels) {
  OutputFile file(path);
  file.append(profile_picture(title, panels));
  file.finish();
}

}  // namespace

int compare_profile(const Arguments& arguments) {
  if (!arguments.names.empty()) throw std::invalid_argument("compare: --profile stands alone (expected no further problem)");
  check_report(arguments);
  const Options options = comparison_options(arguments);
  const std::vector<SolverDescription> solvers = chosen_solvers(arguments);
  std::vector<std::string> names, columns = {"cost", "ratio"};
  for (const SolverDescription& s : solvers) names.push_back(s.name);
  columns.insert(columns.end(), names.begin(), names.end());

  std::vector<NamedProblem> problems;
  for (const std::string& file : nl_files(arguments.profile)) problems.push_back(load_problem(file));

  std::string stem = arguments.output.empty() ? "profile" : arguments.output;
  if (stem.ends_with(".csv")) stem.resize(stem.size() - 4);
  CsvWriter curves(stem + ".csv", columns);
  CsvWriter table(stem + "_problems.csv", {"problem", "variables", "constraints", "solver", "status", "objective", "residual",
                                           "residual_scaled", "iterations", "time_s"});
  check_output_path(stem + ".svg");

  std::vector<std::vector<double>> times(problems.size()), iterations(problems.size());
  std::vector<int> solved(names.size(), 0);
  {
    Progress progress("compare", std::ssize(problems) * std::ssize(solvers), arguments.quiet);
    long done = 0;
    for (std::size_t p = 0; p < problems.size(); ++p) {
      for (std::size_t s = 0; s < names.size(); ++s) {
        if (interrupted()) return kInterrupted;
        const Measurement m = timed(problems[p], names[s], options);
        write_problem(table, problems[p], m);
        const bool is_solved = m.refusal.empty() && succeeded(m.result.status);
        times[p].push_back(is_solved ? m.time : kNever);
        iterations[p].push_back(is_solved ? std::max(m.result.iterations, 1) : kNever);
        solved[s] += is_solved;
        progress.update(++done);
      }
    }
  }
  const PerformanceProfile by_time = performance_profile(names, times), by_iterations = performance_profile(names, iterations);
  write_profile(curves, "time", by_time);
  write_profile(curves, "iterations", by_iterations);
  curves.finish();
  table.finish();
  write_picture(stem + ".svg", fmt::format("{} problems, tolerance {}", problems.size(), options.tolerance),
                {{"problems solved, by time", by_time}, {"problems solved, by iterations", by_iterations}});
  make_report(arguments, {stem + ".csv"});

  Table summary({"solver", "solved", "fastest", "fewest iterations"});
  for (std::size_t s = 0; s < names.size(); ++s) {
    summary.add({names[s], fmt::format("{}", solved[s]), fmt::format("{:.0f} %", 100 * by_time.shares[s].front()),
                 fmt::format("{:.0f} %", 100 * by_iterations.shares[s].front())});
  }
  if (!arguments.quiet) {
    fmt::print("{}: {} problems, tolerance {}, at most {} s each\n{}in {}.csv, {}.svg, {}_problems.csv\n", arguments.profile,
               problems.size(), options.tolerance, options.time_limit, summary.text(), stem, stem, stem);
  }
  return kFinished;
}

}  // namespace tenon
