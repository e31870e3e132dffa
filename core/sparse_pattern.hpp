// Where a sparse matrix may be non-zero: compressed columns (CSC), row indices ascending in each column.
//
// A problem states its patterns once; every evaluation then writes values only, in the order of `inner`.
#pragma once

#include <utility>
#include <vector>

#include "tenon/core/eigen.hpp"

namespace tenon {

struct SparsePattern {
  int rows = 0;
  int cols = 0;
  std::vector<int> outer;  // cols + 1: column j owns the entries outer[j] .. outer[j+1]-1
  std::vector<int> inner;  // row of each entry

  int nonzeros() const { return static_cast<int>(inner.size()); }

  /// Every entry, column by column: the storage order of a dense column-major matrix.
  static SparsePattern full(int rows, int cols);

  /// Every entry on and below the diagonal of an n x n matrix.
  static SparsePattern full_lower(int n);

  /// The union of (row, column) pairs, in any order, repetitions allowed.
  /// Throws std::invalid_argument where a pair lies outside rows x cols.
  static SparsePattern from_entries(int rows, int cols, std::vector<std::pair<int, int>> entries);

  /// Position of (row, col) in `inner`, or -1.
  int find(int row, int col) const;

  /// A matrix with this pattern and all values zero.
  SparseMatrix zero_matrix() const;

  bool operator==(const SparsePattern&) const = default;
};

}  // namespace tenon
