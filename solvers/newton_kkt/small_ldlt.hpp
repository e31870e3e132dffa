// LDL' of a symmetric matrix of a few rows, without pivoting: the 6 x 6 of wrench allocation. All loops are of constant length and unrolled,
// so that the whole factor lives in registers.
//
// Without pivoting an indefinite matrix can meet a small pivot; that is reported as a zero, and the caller regularises.
#pragma once

#include <cmath>

#include "tenon/core/eigen.hpp"
#include "tenon/solvers/newton_kkt/inertia.hpp"

namespace tenon {

template <class Scalar, int M>
class SmallLdlt {
 public:
  using Matrix = Eigen::Matrix<Scalar, M, M>;
  using Vec = Eigen::Matrix<Scalar, M, 1>;

  /// Factors the lower triangle of `a`.
  Inertia factor(const Matrix& a) {
    Scalar w[M][M];  // w[j][i]: row i of column j, i >= j
    Scalar largest = 0;
#pragma GCC unroll 12
    for (int j = 0; j < M; ++j) {
#pragma GCC unroll 12
      for (int i = j; i < M; ++i) w[j][i] = a(i, j);
      largest = std::max(largest, std::abs(w[j][j]));
    }
    Scalar pivots[M];
#pragma GCC unroll 12
    for (int j = 0; j < M; ++j) {
      pivots[j] = w[j][j];
      const Scalar inverse = 1 / w[j][j];
      inverse_d_[j] = inverse;
#pragma GCC unroll 12
      for (int k = j + 1; k < M; ++k) {
        const Scalar factor = w[j][k] * inverse;
        l_[j][k] = factor;
#pragma GCC unroll 12
        for (int i = k; i < M; ++i) w[k][i] -= w[j][i] * factor;
      }
    }
    const Scalar tiny = largest * std::numeric_limits<Scalar>::epsilon() * 4;
    Inertia inertia;
#pragma GCC unroll 12
    for (int j = 0; j < M; ++j) {
      inertia.positive += pivots[j] > tiny;
      inertia.negative += pivots[j] < -tiny;
    }
    inertia.zero = M - inertia.positive - inertia.negative;
    return inertia;
  }

  /// b <- (L D L')^-1 b
  void solve_in_place(Vec& b) const {
    Scalar x[M];
#pragma GCC unroll 12
    for (int i = 0; i < M; ++i) x[i] = b[i];
#pragma GCC unroll 12
    for (int j = 0; j < M; ++j) {
#pragma GCC unroll 12
      for (int i = j + 1; i < M; ++i) x[i] -= l_[j][i] * x[j];
    }
#pragma GCC unroll 12
    for (int i = 0; i < M; ++i) x[i] *= inverse_d_[i];
#pragma GCC unroll 12
    for (int j = M - 1; j >= 0; --j) {
#pragma GCC unroll 12
      for (int i = 0; i < j; ++i) x[i] -= l_[i][j] * x[j];
    }
#pragma GCC unroll 12
    for (int i = 0; i < M; ++i) b[i] = x[i];
  }

 private:
  Scalar l_[M][M];  // l_[j][i]: row i of column j, i > j
  Scalar inverse_d_[M];
};

}  // namespace tenon
