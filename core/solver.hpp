// A solver of one Nlp, for those who hold it without knowing which it is.
#pragma once

#include "tenon/core/options.hpp"
#include "tenon/core/point.hpp"
#include "tenon/core/result.hpp"

namespace tenon {

class Solver {
 public:
  virtual ~Solver() = default;

  /// Starts from `point`, ends in it: whatever the status, it is then the last accepted iterate. Does not throw for the outcome of a solve.
  /// Throws std::invalid_argument where the point has the wrong sizes, or bounds cross.
  virtual Result solve(Point& point) = 0;
};

/// Throws std::invalid_argument, naming the variable or row and both values, where lower > upper, a bound is NaN or a compliance is negative.
void validate(const Nlp& problem, const Bounds& bounds);

/// Throws std::invalid_argument where a row is soft: a back end takes its slacks (with_soft_rows.hpp, which make_solver sees to).
void refuse_soft_rows(const Nlp& problem);

/// Throws std::invalid_argument where the point's vectors do not have n, m and n entries.
void validate(const Nlp& problem, const Point& point);

}  // namespace tenon
