// R with R'R = A'A for a matrix of six columns given row by row, by Householder's reflections: A'A, whose entries are squares, is never formed.
#pragma once

#include <cmath>

#include "tenon/problems/allocation/allocator.hpp"
#include "tenon/problems/allocation/vehicle.hpp"

namespace tenon {

class RowFactor {
 public:
  void add(const Wrench& row) { rows_[count_++] = row; }

  void factor() {
    for (int k = 0; k < 6; ++k) {
      double square = 0;
      for (int r = k; r < count_; ++r) square += rows_[r][k] * rows_[r][k];
      const double head = rows_[k][k], length = head > 0 ? -std::sqrt(square) : std::sqrt(square);
      // v = a - length e_k,    a_j <- a_j - (v'a_j) v / (v'v/2),    v'v/2 = length (length - head)
      const double half = length * (length - head);
      rows_[k][k] = head - length;
      Wrench product = Wrench::Zero();
      for (int r = k; r < count_; ++r) product += rows_[r][k] * rows_[r];
      product /= half;
      product[k] = 0;
      for (int r = k; r < count_; ++r) rows_[r] -= rows_[r][k] * product;
      rows_[k][k] = length;
    }
  }

  /// x of R'R x = b.
  Wrench solve(Wrench b) const {
    for (int k = 0; k < 6; ++k) {
      b[k] /= rows_[k][k];
      for (int j = k + 1; j < 6; ++j) b[j] -= rows_[k][j] * b[k];
    }
    for (int k = 5; k >= 0; --k) {
      for (int j = k + 1; j < 6; ++j) b[k] -= rows_[k][j] * b[j];
      b[k] /= rows_[k][k];
    }
    return b;
  }

 private:
  Wrench rows_[2 * kMaxRotors + 6];
  int count_ = 0;
};

}  // namespace tenon
