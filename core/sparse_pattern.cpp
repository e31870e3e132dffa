#include "tenon/core/sparse_pattern.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace tenon {

SparsePattern SparsePattern::full(int rows, int cols) {
  SparsePattern pattern{rows, cols, {0}, {}};
  for (int j = 0; j < cols; ++j) {
    for (int i = 0; i < rows; ++i) pattern.inner.push_back(i);
    pattern.outer.push_back(pattern.nonzeros());
  }
  return pattern;
}

SparsePattern SparsePattern::full_lower(int n) {
  SparsePattern pattern{n, n, {0}, {}};
  for (int j = 0; j < n; ++j) {
    for (int i = j; i < n; ++i) pattern.inner.push_back(i);
    pattern.outer.push_back(pattern.nonzeros());
  }
  return pattern;
}

SparsePattern SparsePattern::from_entries(int rows, int cols, std::vector<std::pair<int, int>> entries) {
  for (const auto& [row, col] : entries) {
    if (row < 0 || row >= rows || col < 0 || col >= cols) {
      throw std::invalid_argument("sparse pattern: entry (" + std::to_string(row) + ", " + std::to_string(col) + ") lies outside a " +
                                  std::to_string(rows) + " x " + std::to_string(cols) + " matrix");
    }
  }
  std::sort(entries.begin(), entries.end(), [](auto a, auto b) { return std::pair(a.second, a.first) < std::pair(b.second, b.first); });
  entries.erase(std::unique(entries.begin(), entries.end()), entries.end());

  SparsePattern pattern{rows, cols, std::vector<int>(static_cast<std::size_t>(cols) + 1, 0), {}};
  for (const auto& [row, col] : entries) {
    pattern.inner.push_back(row);
    ++pattern.outer[static_cast<std::size_t>(col) + 1];
  }
  for (std::size_t j = 1; j < pattern.outer.size(); ++j) pattern.outer[j] += pattern.outer[j - 1];
  return pattern;
}

int SparsePattern::find(int row, int col) const {
  const auto begin = inner.begin() + outer[static_cast<std::size_t>(col)];
  const auto end = inner.begin() + outer[static_cast<std::size_t>(col) + 1];
  const auto at = std::lower_bound(begin, end, row);
  return at != end && *at == row ? static_cast<int>(at - inner.begin()) : -1;
}

SparseMatrix SparsePattern::zero_matrix() const {
  SparseMatrix matrix(rows, cols);
  matrix.resizeNonZeros(nonzeros());
  std::copy(outer.begin(), outer.end(), matrix.outerIndexPtr());
  std::copy(inner.begin(), inner.end(), matrix.innerIndexPtr());
  std::fill_n(matrix.valuePtr(), nonzeros(), 0.0);
  return matrix;
}

}  // namespace tenon
