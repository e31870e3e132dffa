// tenon compare VEHICLE --rows N --seed S: random rows of an allocation on every back end, in the formulation of the notes.
//
// Soft limits and the vehicle's weights; each row a wrench in a random orientation, |F - weight| <= 10 N, |M| <= 1.5 N m, arms up to 0.2 rad
// away from the linear solution one tick (1/240 s) before. Every solver starts from the linear solution, without multipliers.
#include <fmt/format.h>

#include "tenon/apps/allocators/allocation_row.hpp"
#include "tenon/apps/compare.hpp"
#include "tenon/apps/interrupt.hpp"
#include "tenon/apps/progress.hpp"
#include "tenon/apps/row_comparison.hpp"
#include "tenon/apps/verb.hpp"
#include "tenon/problems/allocation/vehicle_file.hpp"
#include "tenon/problems/allocation/wrench_sequences.hpp"

namespace tenon {

namespace {

constexpr int kDefaultRows = 200;
constexpr const char* kNewtonKkt = "newton-kkt";              // on the fixed-size problem
constexpr const char* kNewtonKktSparse = "newton-kkt-sparse";  // the same loop on the lifted problem

/// What can be compared here: the back ends, Newton-KKT twice.
std::vector<SolverDescription> solvers_of_rows() {
  std::vector<SolverDescription> solvers = list_solvers();
  for (std::size_t s = 0; s < solvers.size(); ++s) {
    if (solvers[s].name != kNewtonKkt) continue;
    SolverDescription fixed = solvers[s];
    solvers[s].name = kNewtonKktSparse;
    fixed.options = "exact Hessian, fixed size, 2 x 2 blocks condensed to 6 x 6";
    solvers.insert(solvers.begin() + static_cast<std::ptrdiff_t>(s), fixed);
    break;
  }
  return solvers;
}

}  // namespace

int compare_vehicle(const std::string& name, const Arguments& arguments) {
  Vehicle vehicle = load_vehicle(name, arguments.set).vehicle;
  vehicle.hard_limits = false;
  const Options options = arguments.options();
  const std::vector<SolverDescription> solvers = chosen_solvers(arguments, solvers_of_rows());
  const std::uint64_t seed = arguments.seed.value_or(1);
  const std::vector<RandomRow> rows = random_rows(vehicle, arguments.rows > 0 ? arguments.rows : kDefaultRows, seed);
  const std::unique_ptr<AllocationRow> problem = make_allocation_row(vehicle, options);

  std::vector<std::string> names;
  for (const SolverDescription& s : solvers) names.push_back(s.name);
  RowComparison comparison(names, options.tolerance);
  std::optional<CsvWriter> record = comparison_record(arguments);
  {
    Progress progress("compare", std::ssize(rows), arguments.quiet);
    long done = 0;
    Point start(problem->lifted().num_variables(), problem->lifted().num_constraints());
    for (const RandomRow& row : rows) {
      problem->set(row.wrench, row.previous, kSequenceStep);
      start.x << row.throttle, row.angle;
      for (std::size_t s = 0; s < names.size(); ++s) {
        if (interrupted()) return kInterrupted;
        const Measurement m = names[s] == kNewtonKkt ? problem->measure_fixed_size(start, kTimedRuns)
                                                     : measure(problem->lifted(), names[s] == kNewtonKktSparse ? kNewtonKkt : names[s], options,
                                                               start, kTimedRuns);
        comparison.add(s, m);
        if (record && m.refusal.empty()) {
          write_comparison(*record, fmt::format("row {}", done + 1), names[s], to_string(m.result.status), m.result.objective,
                           m.result.residual.max(), m.result.iterations, m.time);
        }
      }
      progress.update(++done);
    }
  }
  if (record) finish_comparison(*record, arguments);
  if (arguments.json) {
    print(Json::object()
              .set("schema", 1)
              .set("problem", vehicle.name)
              .set("rows", static_cast<long>(rows.size()))
              .set("seed", static_cast<long>(seed))
              .set("tolerance", options.tolerance)
              .set("timed_runs", kTimedRuns)
              .set("solvers", solvers_json(solvers))
              .set("results", comparison.json()));
    return kFinished;
  }
  fmt::print("{}: {} random rows, seed {}; soft limits, start from the linear solution\n{}\n", vehicle.name, rows.size(), seed,
             comparison.text());
  fmt::print(
      "agree: rows within 1e-6 of the lowest objective that any solver found (relative); above best: the largest distance from it\n"
      "residual: the largest of the unscaled KKT residual, maximum / median over the rows; iterations: median / p99 / sum\n"
      "evaluations: objective/gradient/constraints/Jacobian/Hessian, mean of a row\n"
      "time: the solve alone, median of {} for each row, then median / p99 over the rows; tolerance {} for all, printing off\n",
      kTimedRuns, options.tolerance);
  print_solvers(solvers);
  return kFinished;
}

}  // namespace tenon
