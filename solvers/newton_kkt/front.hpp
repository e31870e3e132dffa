// Partial L D L' of one front: a dense symmetric matrix whose first columns alone may be pivots, because only they are summed up.
//
//                columns         rest
//           +---------------+-----------+
//     F  =  |  A11          |           |        eliminate as many columns as are stable; each row of L stays within 1/u.
//           |  A21          |  (A22)    |        A22 lives elsewhere and later receives  A22 - L21 W21',  W = L D.
//           +---------------+-----------+
//
// A column without a stable pivot is left over ("delayed"): the parent front has more columns summed up, and so more choice.
// Sources: Duff, Reid, ACM TOMS 9 (1983) 302; Duff, ACM TOMS 30 (2004) 118. Equations: linear_algebra.md (4.1)-(4.5).
#pragma once

#include "tenon/solvers/newton_kkt/inertia.hpp"

namespace tenon {

struct Front {
  double* panel = nullptr;      // lower trapezoid of rows x columns, column-major, in whole lanes; becomes L
  double* unscaled = nullptr;   // stride x columns: W = L D, the columns before their division by the pivot
  double* magnitude = nullptr;  // rows: size of the numbers whose differences made each row (2.5)
  int* ids = nullptr;           // columns: which row of K each is; permuted as the columns are
  double* d_inverse = nullptr;        // columns: diagonal of D^-1 ...
  double* d_inverse_below = nullptr;  // ... and the entry below it, 0 in a 1x1 block
  int stride = 0;
  int rows = 0;
  int columns = 0;
  int eliminated = 0;  // the first of the columns; the others are left over

  double* column(int j) { return panel + static_cast<long>(j) * stride; }
  double* unscaled_column(int j) { return unscaled + static_cast<long>(j) * stride; }
};

inline constexpr double kPivotThreshold = 0.01;  // u of (4.2)

/// Eliminates what is stable, |L| <= 1/u, and adds to the inertia.
void eliminate_stable(Front& front, Inertia& inertia, double threshold = kPivotThreshold);

/// Eliminates the remaining columns whatever they are; a pivot that is next to nothing is perturbed and counted as a zero.
void eliminate_rest(Front& front, Inertia& inertia);

}  // namespace tenon
