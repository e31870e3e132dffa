// The parts of `tenon compare` that the problems of a catalogue and the rows of a vehicle share.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tenon/apps/arguments.hpp"
#include "tenon/apps/json.hpp"
#include "tenon/apps/named_problem.hpp"
#include "tenon/core/csv.hpp"
#include "tenon/solvers/make_solver.hpp"

namespace tenon {

/// Of the `known` back ends those of --solvers, else every one that is available. Throws std::invalid_argument for one that is not known
/// or not available.
std::vector<SolverDescription> chosen_solvers(const Arguments& arguments, const std::vector<SolverDescription>& known = list_solvers());

inline constexpr int kTimedRuns = 5;            // of a solve, for the clock
inline constexpr double kWorthRepeating = 0.1;  // s; a longer solve is timed once

/// What is asked for; without a time limit 10 s: one creeping solver shall not hold up the rest.
Options comparison_options(const Arguments& arguments, const Options& of_problem = {});

/// One problem on one back end, timed over kTimedRuns.
Measurement timed(const NamedProblem& named, const std::string& solver, const Options& options);

/// The record of a comparison: where --output says, else beside the report; nothing where neither is asked for. Both paths are checked.
std::optional<CsvWriter> comparison_record(const Arguments& arguments);
void write_comparison(CsvWriter& csv, const std::string& problem, const std::string& solver, std::string_view status, double objective, double residual,
                      int iterations, double time);
/// Closes the record and makes the report that is asked for.
void finish_comparison(CsvWriter& csv, const Arguments& arguments);

/// As the record of a comparison has them: name, description, options.
Json solvers_json(const std::vector<SolverDescription>& solvers);
void print_solvers(const std::vector<SolverDescription>& solvers);

/// `tenon compare VEHICLE --rows N --seed S`: random rows of an allocation on every back end. Returns an ExitCode.
int compare_vehicle(const std::string& vehicle, const Arguments& arguments);

/// `tenon compare --profile DIR`: every .nl file of a folder on every back end, as a performance profile. Returns an ExitCode.
int compare_profile(const Arguments& arguments);

}  // namespace tenon
