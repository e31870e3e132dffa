// min |A y - b|_2  s.t.  y >= 0,  by active sets.
//
// [LH74] C. L. Lawson, R. J. Hanson, Solving Least Squares Problems, Prentice-Hall (1974), algorithm NNLS, chapter 23.
#pragma once

#include <limits>

#include "tenon/core/eigen.hpp"

namespace tenon {

/// The minimiser y. The columns of A where y > 0 are linearly independent. Columns of one size are best.
/// After about `most_work` multiplications it is what was found so far.
Vector nonnegative_least_squares(const Eigen::MatrixXd& A, const Vector& b, double most_work = std::numeric_limits<double>::infinity());

}  // namespace tenon
