// A primal-dual point: where a solve starts from, and where it ends.
#pragma once

#include "tenon/core/nlp.hpp"

namespace tenon {

template <class Scalar, int N, int M>
struct BasicPoint {
  Eigen::Matrix<Scalar, N, 1> x;       // n: the variables
  Eigen::Matrix<Scalar, M, 1> lambda;  // m: multipliers of the rows, > 0 at an upper bound, < 0 at a lower one
  Eigen::Matrix<Scalar, N, 1> z;       // n: multipliers of the variables' bounds, same sign

  BasicPoint() : BasicPoint(N == Dynamic ? 0 : N, M == Dynamic ? 0 : M) {}

  BasicPoint(int n, int m) {
    x.setZero(n);
    lambda.setZero(m);
    z.setZero(n);
  }
};

using Point = BasicPoint<double, Dynamic, Dynamic>;

template <class P>
using PointOf = BasicPoint<typename P::Scalar, P::kVariables, P::kConstraints>;

}  // namespace tenon
