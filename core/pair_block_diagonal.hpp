// A symmetric matrix of N blocks of 2 x 2 for variables ordered (u_1 .. u_N, a_1 .. a_N): block i couples u_i and a_i alone.
//
//     H = [ diag(uu)  diag(au) ]
//         [ diag(au)  diag(aa) ]
//
// The Hessian of every problem whose pairs of variables meet only in the constraints, such as wrench allocation.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "tenon/core/sparse_pattern.hpp"

namespace tenon {

template <class Scalar, int N>
struct PairBlockDiagonal {
  using Diagonal = Eigen::Array<Scalar, N, 1>;
  Diagonal uu, au, aa;  // N each

  /// Lower triangle in compressed columns: column u_i holds (u_i, a_i), column a_i holds a_i.
  static SparsePattern lower_pattern() {
    std::vector<std::pair<int, int>> entries;
    for (int i = 0; i < N; ++i) {
      entries.emplace_back(i, i);
      entries.emplace_back(N + i, i);
      entries.emplace_back(N + i, N + i);
    }
    return SparsePattern::from_entries(2 * N, 2 * N, std::move(entries));
  }

  /// The values in the order of lower_pattern().
  void write_lower(std::span<double> values) const {
    for (int i = 0; i < N; ++i) {
      values[static_cast<std::size_t>(2 * i)] = double(uu[i]);
      values[static_cast<std::size_t>(2 * i + 1)] = double(au[i]);
      values[static_cast<std::size_t>(2 * N + i)] = double(aa[i]);
    }
  }
};

}  // namespace tenon
