// What the rows of the optimal control problems share: solves from the problem's own start, or from a given point.
#pragma once

#include <fmt/format.h>

#include "tenon/apps/benchmark/benchmark.hpp"
#include "tenon/core/solver.hpp"

namespace tenon {

/// `runs` solves from `start`, by anything with solve(Point&).
template <class Solver>
void time_solves(Solver& solver, const Point& start, int runs, BenchmarkRun& out) {
  Point point = start;
  Result result;
  for (int run = 0; run < runs; ++run) {
    point = start;
    time_each(1, out, [&](int) { result = solver.solve(point); });
  }
  out.notes.push_back(fmt::format("{}, {} iterations, objective {:.10g}", to_string(result.status), result.iterations, result.objective));
}

inline Point start_of(const Nlp& problem) {
  Point start(problem.num_variables(), problem.num_constraints());
  problem.initial_point(start.x);
  return start;
}

}  // namespace tenon
