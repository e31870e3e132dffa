// Many starts, for problems with many local optima: the same solver from points strewn about the start, and the distinct ends it comes to.
#pragma once

#include <cstdint>
#include <vector>

#include "tenon/core/solver.hpp"

namespace tenon {

/// An end of some of the solves.
struct Optimum {
  Point start;    // where the first of them began
  Point point;    // and ended
  Result result;  // of that one
  int found = 1;  // how many of them
};

struct MultiStart {
  std::vector<Optimum> optima;  // distinct solutions, lowest objective first; where no solve succeeded, the one end with the least residual
  int starts = 0;               // solves made
  int failed = 0;               // those that did not succeed
};

/// Solves from `start`, and from starts - 1 further points x drawn evenly from
///
///     [x_lower, x_upper]  and  [x_s - r, x_s + r],   r = 10 max(1, |x_s|)        x_s: the start, inside its bounds
///
/// with multipliers 0. Two solutions are one where their x agree within 1e-4 max(1, |x|). The same seed gives the same points. Ends early
/// where a solve was stopped by its observer. Throws std::invalid_argument where starts < 1, and what the solver throws.
MultiStart multi_start(const Nlp& problem, Solver& solver, const Point& start, int starts, std::uint64_t seed);

}  // namespace tenon
