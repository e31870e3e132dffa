// One problem on one back end: solved, judged by the independent ruler, evaluations counted, the solve alone timed.
#pragma once

#include <string>

#include "tenon/core/counted.hpp"
#include "tenon/core/options.hpp"
#include "tenon/core/point.hpp"
#include "tenon/core/result.hpp"

namespace tenon {

struct Measurement {
  std::string solver;
  std::string refusal;  // why the back end does not take the problem; all that follows is then void
  Result result;        // of the counted solve
  EvaluationCounts counts;
  Point point;      // where it ended
  double time = 0;  // s, median of the timed solves, which nothing counts or watches
};

/// Solves once counted, from `start`, then `timed_runs` times for the clock alone. Throws std::invalid_argument for an unknown solver.
Measurement measure(const Nlp& problem, const std::string& solver, const Options& options, const Point& start, int timed_runs);

/// The point that the problem suggests, multipliers 0.
Point suggested_start(const Nlp& problem);

}  // namespace tenon
