// Iterative refinement in working precision:  x <- x + K^-1 (r - K x), until each row is as good as rounding allows.
//
// Two measures of an iterate: the backward error row by row, (1.4)
//     omega = max_i |r - K x|_i / (|K| |x| + |r|)_i,
// the smallest relative change of the entries of K and r that makes x exact, and the largest residual. Rows where all terms vanish keep
// the first from falling, the second has a floor of rounding: a step counts as progress where it halves either.
//
// Sources: Skeel, Math. Comp. 35 (1980) 817; Arioli, Demmel, Duff, SIAM J. Matrix Anal. Appl. 10 (1989) 165.
#pragma once

#include <limits>

namespace tenon {

/// Good enough: a few roundings in each row.
template <class Scalar>
inline constexpr Scalar kRowError = 16 * std::numeric_limits<Scalar>::epsilon();

template <class Scalar>
struct BackwardError {
  Scalar by_row = 0;   // omega of (1.4)
  Scalar largest = 0;  // max |r - K x|
};

/// x: an approximate solution; it is improved. apply_inverse(v): v <- K^-1 v, approximately. measure(): sets `residual` to r - K x and
/// returns how large it is. previous: storage. Returns the error that is left.
template <class VectorType, class ApplyInverse, class Measure>
auto refine(VectorType& x, VectorType& residual, VectorType& previous, int steps, ApplyInverse apply_inverse, Measure measure) {
  using Scalar = typename VectorType::Scalar;
  BackwardError<Scalar> error = measure();
  for (int step = 0; step < steps && error.by_row > kRowError<Scalar>; ++step) {
    previous = x;
    apply_inverse(residual);
    x += residual;
    const BackwardError<Scalar> next = measure();
    if (!(next.by_row < error.by_row || next.largest < error.largest)) {
      x = previous;
      break;
    }
    const bool slow = next.by_row > error.by_row / 2 && next.largest > error.largest / 2;
    error = next;
    if (slow) break;
  }
  return error;
}

}  // namespace tenon
