// LDL' of a symmetric matrix of a few rows, without pivoting, every loop of constant length: the 6 x 6 of wrench allocation.
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
    Inertia inertia;
    const Scalar tiny = a.diagonal().cwiseAbs().maxCoeff() * std::numeric_limits<Scalar>::epsilon() * 4;
    l_ = a;
    for (int j = 0; j < M; ++j) {
      const Scalar pivot = l_(j, j);
      const Scalar inverse = 1 / pivot;
      inertia.positive += pivot > tiny;
      inertia.negative += pivot < -tiny;
      inverse_d_[j] = inverse;
      for (int k = j + 1; k < M; ++k) {
        const Scalar factor = l_(k, j) * inverse;
        for (int i = k; i < M; ++i) l_(i, k) -= l_(i, j) * factor;
      }
      for (int i = j + 1; i < M; ++i) l_(i, j) *= inverse;
    }
    inertia.zero = M - inertia.positive - inertia.negative;
    return inertia;
  }

  void solve_in_place(Vec& b) const {
    for (int j = 0; j < M; ++j) {
      for (int i = j + 1; i < M; ++i) b[i] -= l_(i, j) * b[j];
    }
    b.array() *= inverse_d_.array();
    for (int j = M - 1; j >= 0; --j) {
      for (int i = j + 1; i < M; ++i) b[j] -= l_(i, j) * b[i];
    }
  }

 private:
  Matrix l_;
  Vec inverse_d_;
};

}  // namespace tenon
