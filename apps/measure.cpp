#include "tenon/apps/measure.hpp"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "tenon/apps/interrupt.hpp"
#include "tenon/apps/statistics.hpp"
#include "tenon/solvers/make_solver.hpp"

namespace tenon {

namespace {

bool is_available(const std::string& solver) {
  const std::vector<SolverDescription> known = list_solvers();
  return std::any_of(known.begin(), known.end(), [&](const SolverDescription& s) { return s.name == solver && s.available; });
}

}  // namespace

Point suggested_start(const Nlp& problem) {
  Point point(problem.num_variables(), problem.num_constraints());
  problem.initial_point(point.x);
  return point;
}

Measurement measure(const Nlp& problem, const std::string& solver, const Options& options, const Point& start, int timed_runs) {
  Measurement out;
  out.solver = solver;
  out.point = start;
  const CountedNlp counted(problem, out.counts);
  std::unique_ptr<Solver> counting;
  try {
    counting = make_solver(solver, counted, options);
  } catch (const std::invalid_argument& error) {
    if (!is_available(solver)) throw;  // a name that makes no sense, not a problem that this back end cannot take
    out.refusal = error.what();
    return out;
  }
  out.counts = {};
  out.result = counting->solve(out.point);
  out.time = out.result.elapsed;

  std::vector<double> times;
  Options unwatched = options;
  unwatched.on_iteration = nullptr;
  const std::unique_ptr<Solver> timed = timed_runs > 0 ? make_solver(solver, problem, unwatched) : nullptr;
  for (int k = 0; k < timed_runs && !interrupted(); ++k) {
    Point point = start;
    times.push_back(timed->solve(point).elapsed);
  }
  if (!times.empty()) out.time = median(times);
  return out;
}

}  // namespace tenon
