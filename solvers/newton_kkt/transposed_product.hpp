// y += J' lambda for a Jacobian in compressed columns, by its dense blocks: neighbouring columns with entries in the same neighbouring rows,
// as the stages of an optimal control problem have them. Four columns at a time share the loads of lambda.
#pragma once

#include <vector>

#include "tenon/core/sparse_pattern.hpp"
#include "tenon/solvers/newton_kkt/lanes.hpp"

namespace tenon {

class TransposedProduct {
 public:
  explicit TransposedProduct(const SparsePattern& jacobian);

  /// y: n; lambda: m.
  void add(const SparseMatrix& jacobian, const Vector& lambda, Vector& y) const {
    const double* values = jacobian.valuePtr();
    for (const Entry& entry : entries_) y[entry.column] += values[entry.source] * lambda[entry.row];
    for (const Block& block : blocks_) {
      int j = 0;
      for (; j + 4 <= block.columns; j += 4) add_columns<4>(block, j, values, lambda.data(), y.data());
      if (j + 2 <= block.columns) add_columns<2>(block, j, values, lambda.data(), y.data()), j += 2;
      if (j < block.columns) add_columns<1>(block, j, values, lambda.data(), y.data());
    }
  }

 private:
  struct Entry {
    int row, column, source;
  };
  struct Block {
    int row, rows, column, columns;
    int source, stride;  // of the first value; from column to column
  };

  template <int Columns>
  static void add_columns(const Block& block, int j, const double* values, const double* lambda, double* y) {
    using Lane = lanes::Lane<double>;
    const double* from = values + block.source + j * block.stride;
    lambda += block.row;
    Lane sum[Columns];
    for (Lane& lane : sum) lane.setZero();
    int i = 0;
    for (; i + 4 <= block.rows; i += 4) {
      const Lane factor = Eigen::Map<const Lane>(lambda + i);
      for (int c = 0; c < Columns; ++c) sum[c] += Eigen::Map<const Lane>(from + c * block.stride + i) * factor;
    }
    double* to = y + block.column + j;
    for (int c = 0; c < Columns; ++c) to[c] += sum[c].sum();
    for (; i < block.rows; ++i) {
      for (int c = 0; c < Columns; ++c) to[c] += from[c * block.stride + i] * lambda[i];
    }
  }

  std::vector<Block> blocks_;
  std::vector<Entry> entries_;  // the blocks of one entry
};

}  // namespace tenon
