// Rows and bounds that cannot be met together.
//
// Linearised at x, every side of a hard row and every bound asks  a_k' d <= b_k  of a step d. No step meets a set K of them if and only if
//
//     some y >= 0 has   sum_K y_k a_k = 0,   sum_K y_k b_k < 0                                          [Farkas 1902]     (1)
//
// which least squares looks for:  min | [ a_k' ; b_k ] y - (0, ..., 0, -1) |  s.t.  y >= 0 (nonnegative_least_squares.hpp). Its columns
// with y > 0 are linearly independent, so that (1) fails for every smaller set of them: K is irreducible. Where the rows are linear, K is a
// proof; else it says what holds to first order at x, and at a stationary point of the violation (an infeasible end) there is such a K.
#pragma once

#include <string>
#include <vector>

#include "tenon/core/first_order.hpp"

namespace tenon {

/// A row, or a variable with its bounds, at a point.
struct Limit {
  std::string name;
  bool is_bound = false;  // the name is a variable's
  double value = 0;       // of the row or variable
  double lower = 0, upper = 0;
  double violation = 0;   // how far outside, 0 within
  double multiplier = 0;  // its y of (1), largest 1; > 0: its upper side hurts, < 0: its lower one
};

/// An irreducible set of rows and bounds that, linearised at x, no step meets together; worst violation first. Empty where there is none,
/// where x is not finite or the set would take more than seconds to look for (many hundreds of rows in the vicinity).
std::vector<Limit> conflict(const Nlp& problem, const Vector& x);

/// Hard rows and bounds that x violates by more than the tolerance, worst first; multipliers 0.
std::vector<Limit> violated_limits(const Nlp& problem, const Vector& x, double tolerance);

}  // namespace tenon
