// P A P' = L D L' of a dense symmetric matrix, indefinite or not: L unit lower triangular, D made of 1x1 and 2x2 blocks.
//
// Rook pivoting: every entry of L stays below 2.78 in size, and A and D have the same inertia (Sylvester's law). A column that cancels to
// rounding is counted as a zero eigenvalue and solved by the pseudo-inverse. Equations: linear_algebra.md (2.1)-(2.6).
//
// Sources: [BK77] Bunch, Kaufman, Math. Comp. 31 (1977) 163; [AGL98] Ashcraft, Grimes, Lewis, SIAM J. Matrix Anal. Appl. 20 (1998) 513.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "tenon/solvers/newton_kkt/inertia.hpp"
#include "tenon/solvers/newton_kkt/lanes.hpp"

namespace tenon {

template <class Scalar, int Size>
class DenseLdlt {
 public:
  static constexpr int kRows = Size == Dynamic ? Dynamic : lanes::padded<Scalar>(Size);
  using Storage = Eigen::Matrix<Scalar, kRows, Size>;       // whole lanes in each column
  using PaddedVector = Eigen::Matrix<Scalar, kRows, 1>;

  /// Allocates for a matrix of order `size`.
  explicit DenseLdlt(int size = Size) : size_(size) {
    const int rows = lanes::padded<Scalar>(size);
    l_.setZero(rows, size);
    d_inverse_.setZero(rows);
    d_inverse_below_.setZero(rows);
    magnitude_.setZero(rows);
    x_.setZero(rows);
    permutation_.setZero(size);
  }

  int size() const { return size_; }

  /// Factors the matrix whose lower triangle stands in the lower triangle of `a` (padded rows x size; the padding holds zeros).
  Inertia factor(const Storage& a);

  /// x <- A^-1 x, x in whole lanes (the padding is not read).
  void solve_in_place(PaddedVector& x);

 private:
  // (2.3) alpha = (1 + sqrt 17)/8, which makes the bounds on the growth of one 2x2 and of two 1x1 pivots equal  [BK77]
  static constexpr Scalar kAlpha = Scalar(0.6403882032022076);
  // (2.5) a column is zero where it has cancelled below this many units of rounding
  static constexpr Scalar kZero = 64 * std::numeric_limits<Scalar>::epsilon();

  // what is left of an equilibrated matrix below this is nothing; it can still be squared
  static constexpr Scalar kTiny = Scalar(sizeof(Scalar) < sizeof(double) ? 1e-18 : 1e-150);

  Scalar* column(int j) { return l_.data() + static_cast<std::ptrdiff_t>(j) * l_.rows(); }

  int select_pivot(int k);
  Scalar largest_beside(int k, int r, int& index);
  void exchange(int p, int q);
  void eliminate_zero(int k);
  void eliminate_one(int k, Scalar below);
  void eliminate_two(int k);
  void close_column(int k);

  int size_;
  Storage l_;                                       // strictly below the diagonal: L; lanes of a column above it are zero
  PaddedVector d_inverse_, d_inverse_below_;        // D^-1: its diagonal, and the entry below it (0 in a 1x1 block)
  PaddedVector magnitude_;                          // size of the numbers whose differences make column j
  PaddedVector x_;
  Eigen::Matrix<int, Size, 1> permutation_;         // row i of P A P' is row permutation_[i] of A
};

template <class Scalar, int Size>
Inertia DenseLdlt<Scalar, Size>::factor(const Storage& a) {
  l_ = a;
  for (int i = 0; i < size_; ++i) {
    permutation_[i] = i;
    magnitude_[i] = std::abs(l_(i, i));
  }
  d_inverse_below_.setZero();

  Inertia inertia;
  int k = 0;
  while (k < size_) {
    const Scalar below = lanes::max_abs(column(k), k + 1, size_);
    // (2.5) max_i |a_ik| <= kZero magnitude_k; written so that a NaN is a zero too
    if (!(std::max(std::abs(l_(k, k)), below) > std::max(kZero * magnitude_[k], kTiny))) {
      eliminate_zero(k);
      ++inertia.zero;
      ++k;
    } else if (std::abs(l_(k, k)) >= kAlpha * below) {
      ++(l_(k, k) > 0 ? inertia.positive : inertia.negative);
      eliminate_one(k, below);
      ++k;
    } else if (select_pivot(k) == 1) {
      ++(l_(k, k) > 0 ? inertia.positive : inertia.negative);
      eliminate_one(k, lanes::max_abs(column(k), k + 1, size_));
      ++k;
    } else {
      ++inertia.positive;  // rook: both diagonal entries are below alpha |d_21|, hence det < 0
      ++inertia.negative;
      eliminate_two(k);
      k += 2;
    }
  }
  return inertia;
}

// max |a_ir| over i >= k, i != r, in row and column r of the lower triangle; its index.
template <class Scalar, int Size>
Scalar DenseLdlt<Scalar, Size>::largest_beside(int k, int r, int& index) {
  Scalar largest = -1;
  for (int j = k; j < r; ++j) {
    const Scalar value = std::abs(l_(r, j));
    if (value > largest) largest = value, index = j;
  }
  for (int i = r + 1; i < size_; ++i) {
    const Scalar value = std::abs(l_(i, r));
    if (value > largest) largest = value, index = i;
  }
  return largest;
}

// (2.4) Walks to ever larger entries, from column to row, until a diagonal entry or an off-diagonal one rules its row and its column.
// Brings the pivot to the front and returns its order.
template <class Scalar, int Size>
int DenseLdlt<Scalar, Size>::select_pivot(int k) {
  int p = k;
  int r = k;
  Scalar largest = largest_beside(k, p, r);
  while (true) {
    int q = p;
    const Scalar beside = largest_beside(k, r, q);
    if (std::abs(l_(r, r)) >= kAlpha * beside) {
      exchange(k, r);
      return 1;
    }
    if (!(beside > largest)) break;
    p = r;
    r = q;
    largest = beside;
  }
  if (p > r) std::swap(p, r);
  exchange(k, p);
  exchange(k + 1, r);
  return 2;
}

// Exchanges rows and columns p < q of what is left to factor, and the rows of L already made.
template <class Scalar, int Size>
void DenseLdlt<Scalar, Size>::exchange(int p, int q) {
  if (p == q) return;
  for (int j = 0; j < p; ++j) std::swap(l_(p, j), l_(q, j));
  std::swap(l_(p, p), l_(q, q));
  for (int i = p + 1; i < q; ++i) std::swap(l_(i, p), l_(q, i));
  for (int i = q + 1; i < size_; ++i) std::swap(l_(i, p), l_(i, q));
  std::swap(permutation_[p], permutation_[q]);
  std::swap(magnitude_[p], magnitude_[q]);
}

// The lanes of column k up to its diagonal become zero: solves then run over whole lanes.
template <class Scalar, int Size>
void DenseLdlt<Scalar, Size>::close_column(int k) {
  for (int i = lanes::lane_of<Scalar>(k); i <= k; ++i) l_(i, k) = 0;
}

template <class Scalar, int Size>
void DenseLdlt<Scalar, Size>::eliminate_zero(int k) {
  for (int i = lanes::lane_of<Scalar>(k); i < size_; ++i) l_(i, k) = 0;
  d_inverse_[k] = 0;
}

// (2.1) l = a_k / d,  A <- A - l d l'
template <class Scalar, int Size>
void DenseLdlt<Scalar, Size>::eliminate_one(int k, Scalar below) {
  Scalar* a = column(k);
  Scalar* l = x_.data();
  const Scalar inverse = 1 / a[k];
  const Scalar change = std::max(below, std::max(Scalar(1), below * std::abs(inverse)) * magnitude_[k]);  // (2.5)
  for (int i = lanes::lane_of<Scalar>(k + 1); i < size_; i += lanes::kLanes<Scalar>) {
    lanes::Map<Scalar> scaled(l + i), magnitude(magnitude_.data() + i);
    scaled = lanes::ConstMap<Scalar>(a + i) * inverse;
    magnitude = magnitude.max(scaled.abs() * change);
  }
  for (int j = k + 1; j < size_; ++j) lanes::subtract_scaled(l[j], a, column(j), j, size_);
  for (int i = lanes::lane_of<Scalar>(k + 1); i < size_; i += lanes::kLanes<Scalar>) {
    lanes::Map<Scalar>(a + i) = lanes::ConstMap<Scalar>(l + i);
  }
  d_inverse_[k] = inverse;
  close_column(k);
}

// (2.2) [l_1 l_2] = [a_1 a_2] D^-1,  A <- A - [l_1 l_2] D [l_1 l_2]' = A - [l_1 l_2] [a_1 a_2]'
template <class Scalar, int Size>
void DenseLdlt<Scalar, Size>::eliminate_two(int k) {
  Scalar* a1 = column(k);
  Scalar* a2 = column(k + 1);
  const Scalar below = a1[k + 1];
  const Scalar t = a1[k] / below;
  const Scalar s = a2[k + 1] / below;
  const Scalar c = 1 / (below * (t * s - 1));
  d_inverse_[k] = s * c;
  d_inverse_below_[k] = -c;
  d_inverse_[k + 1] = t * c;

  const Scalar below1 = lanes::max_abs(a1, k + 2, size_);
  const Scalar below2 = lanes::max_abs(a2, k + 2, size_);
  const Scalar growth =
      std::max(Scalar(1), std::abs(c) * std::max(std::abs(s) * below1 + below2, below1 + std::abs(t) * below2));
  const Scalar change1 = std::max(below1, growth * magnitude_[k]);  // (2.5)
  const Scalar change2 = std::max(below2, growth * magnitude_[k + 1]);
  for (int j = k + 2; j < size_; ++j) {
    const Scalar l1 = (s * a1[j] - a2[j]) * c;
    const Scalar l2 = (t * a2[j] - a1[j]) * c;
    magnitude_[j] = std::max(magnitude_[j], std::abs(l1) * change1 + std::abs(l2) * change2);
    lanes::subtract_scaled(l1, a1, l2, a2, column(j), j, size_);
    // row j of the two columns is not read again: later columns begin below it
    a1[j] = l1;
    a2[j] = l2;
  }
  a1[k + 1] = 0;
  close_column(k);
  close_column(k + 1);
}

template <class Scalar, int Size>
void DenseLdlt<Scalar, Size>::solve_in_place(PaddedVector& x) {
  Scalar* y = x_.data();
  x_.setZero();
  for (int i = 0; i < size_; ++i) y[i] = x[permutation_[i]];
  // (2.6) L u = P b,  D v = u,  L' w = v,  x = P' w
  for (int k = 0; k < size_; ++k) lanes::subtract_scaled(y[k], column(k), y, k + 1, size_);
  for (int k = 0; k < size_; ++k) {
    if (d_inverse_below_[k] != 0) {
      const Scalar y1 = y[k];
      const Scalar y2 = y[k + 1];
      y[k] = d_inverse_[k] * y1 + d_inverse_below_[k] * y2;
      y[k + 1] = d_inverse_below_[k] * y1 + d_inverse_[k + 1] * y2;
      ++k;
    } else {
      y[k] *= d_inverse_[k];
    }
  }
  for (int k = size_ - 2; k >= 0; --k) y[k] -= lanes::dot(column(k), y, k + 1, size_);
  for (int i = 0; i < size_; ++i) x[permutation_[i]] = y[i];
}

}  // namespace tenon
