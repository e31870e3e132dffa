// Small dense products in whole lanes, for the stages of an optimal control problem. Column-major; every column is 32-byte aligned and
// padded with zeros to whole lanes (lanes.hpp). Where the sizes are constants, all loops unroll.
//
// Tiles of up to 3 lanes x 4 columns stay in registers: twelve sums hide the latency of the multiply-adds.
#pragma once

#include "tenon/solvers/newton_kkt/lanes.hpp"

namespace tenon::stage {

namespace detail {

using Packet = Eigen::internal::find_best_packet<double, 4>::type;
inline constexpr int kPacket = Eigen::internal::unpacket_traits<Packet>::size;  // 4, or what the machine has
inline constexpr int kPackets = lanes::kLanes<double> / kPacket;                // in a lane

inline Packet load(const double* from) {
  return Eigen::internal::ploadt<Packet, Eigen::Aligned32>(from);
}
inline void store(double* to, const Packet& packet) {
  Eigen::internal::pstoret<double, Packet, Eigen::Aligned32>(to, packet);
}
inline Packet fill(double value) {
  return Eigen::internal::pset1<Packet>(value);
}
inline Packet multiply_add(const Packet& a, const Packet& b, const Packet& c) {
  return Eigen::internal::pmadd(a, b, c);
}

}  // namespace detail

/// A factor of a product: column-major (row_step 1), or its transpose.
struct Factor {
  const double* data;
  int row_step, column_step;
  double at(int i, int j) const { return data[i * row_step + j * column_step]; }
};

/// One tile of c: Lanes lanes of rows, Columns columns.
template <int Lanes, int Columns>
struct Tile {
  static constexpr int kRows = Lanes * detail::kPackets;
  detail::Packet sum[Columns][kRows];

  [[gnu::always_inline]] void read(const double* c, int stride) {
    for (int j = 0; j < Columns; ++j) {
      for (int i = 0; i < kRows; ++i) sum[j][i] = detail::load(c + j * stride + i * detail::kPacket);
    }
  }
  [[gnu::always_inline]] void clear() {
    for (auto& column : sum) {
      for (auto& packet : column) packet = detail::fill(0);
    }
  }
  /// += sign a b, a: lanes x depth, b: depth x Columns
  [[gnu::always_inline]] void add(const double* a, int stride, const Factor& b, int depth, double sign = 1) {
    for (int k = 0; k < depth; ++k) {
      detail::Packet left[kRows];
      for (int i = 0; i < kRows; ++i) left[i] = detail::load(a + k * stride + i * detail::kPacket);
      for (int j = 0; j < Columns; ++j) {
        const detail::Packet right = detail::fill(sign * b.at(k, j));
        for (int i = 0; i < kRows; ++i) sum[j][i] = detail::multiply_add(left[i], right, sum[j][i]);
      }
    }
  }
  [[gnu::always_inline]] void operator+=(const Tile& other) {
    for (int j = 0; j < Columns; ++j) {
      for (int i = 0; i < kRows; ++i) sum[j][i] = Eigen::internal::padd(sum[j][i], other.sum[j][i]);
    }
  }
  [[gnu::always_inline]] void write(double* c, int stride) const {
    for (int j = 0; j < Columns; ++j) {
      for (int i = 0; i < kRows; ++i) detail::store(c + j * stride + i * detail::kPacket, sum[j][i]);
    }
  }
};

/// Calls visit(tile, row, column) for tiles that cover rows (in whole lanes) x columns; with `lower`, those that meet the lower triangle.
template <int Columns, class Visit>
[[gnu::always_inline]] inline void over_lanes(int row, int rows, int column, Visit&& visit) {
  for (; row + 12 <= rows; row += 12) visit(Tile<3, Columns>{}, row, column);
  if (row + 8 <= rows) visit(Tile<2, Columns>{}, row, column), row += 8;
  if (row < rows) visit(Tile<1, Columns>{}, row, column);
}
template <class Visit>
[[gnu::always_inline]] inline void over_tiles(int rows, int columns, bool lower, Visit&& visit) {
  rows = lanes::padded<double>(rows);
  int j = 0;
  for (; j + 4 <= columns; j += 4) over_lanes<4>(lower ? j : 0, rows, j, visit);
  const int row = lower ? j : 0;
  if (columns - j == 3) over_lanes<3>(row, rows, j, visit);
  if (columns - j == 2) over_lanes<2>(row, rows, j, visit);
  if (columns - j == 1) over_lanes<1>(row, rows, j, visit);
}

/// c = a b: rows x columns, over `depth`.
[[gnu::always_inline]] inline void product(const double* a, int a_stride, const Factor& b, int depth, double* c, int c_stride, int rows,
                                           int columns) {
  over_tiles(
      rows, columns, false, [&](auto tile, int i, int j) __attribute__((always_inline)) {
        tile.clear();
        tile.add(a + i, a_stride, {b.data + j * b.column_step, b.row_step, b.column_step}, depth);
        tile.write(c + i + j * c_stride, c_stride);
      });
}

/// y += sign a x: rows in whole lanes. Even and odd columns are summed apart, so that the sums need not wait for one another.
[[gnu::always_inline]] inline void add_times(const double* a, int stride, const double* x, int rows, int columns, double* y,
                                             double sign = 1) {
  over_lanes<1>(
      0, lanes::padded<double>(rows), 0, [&](auto even, int i, int) __attribute__((always_inline)) {
        auto odd = even;
        even.read(y + i, 0);
        odd.clear();
        even.add(a + i, 2 * stride, {x, 2, 0}, (columns + 1) / 2, sign);
        odd.add(a + i + stride, 2 * stride, {x + 1, 2, 0}, columns / 2, sign);
        even += odd;
        even.write(y + i, 0);
      });
}

/// at = a', rows x columns the shape of a; the padding of `at` becomes zero.
[[gnu::always_inline]] inline void transpose(const double* a, int a_stride, int rows, int columns, double* at, int at_stride) {
  const int whole = lanes::padded<double>(columns);
  for (int j = 0; j < whole; j += 4) {
    for (int i = 0; i < rows; i += 4) {
      Eigen::Matrix<double, 4, 4> block;
      for (int c = 0; c < 4; ++c) {
        if (j + c < columns)
          block.col(c) = Eigen::Map<const Eigen::Vector4d, Eigen::Aligned32>(a + i + (j + c) * a_stride);
        else
          block.col(c).setZero();
      }
      block.transposeInPlace();
      for (int r = 0; r < 4 && i + r < rows; ++r)
        Eigen::Map<Eigen::Vector4d, Eigen::Aligned32>(at + j + (i + r) * at_stride) = block.col(r);
    }
  }
}

/// Mirrors the lower triangle of p (n x n) by whole 4 x 4 blocks; the blocks on the diagonal hold both triangles and take their mean.
[[gnu::always_inline]] inline void symmetrise(double* p, int stride, int n) {
  using Block = Eigen::Map<Eigen::Matrix<double, 4, 4>, Eigen::Aligned32, Eigen::OuterStride<>>;
  int j = 0;
  for (; j + 4 <= n; j += 4) {
    Block diagonal(p + j + j * stride, Eigen::OuterStride<>(stride));
    Eigen::Matrix<double, 4, 4> mean = diagonal;
    mean.transposeInPlace();
    diagonal = 0.5 * (diagonal + mean);
    for (int i = j + 4; i + 4 <= n; i += 4) {
      Eigen::Matrix<double, 4, 4> below = Block(p + i + j * stride, Eigen::OuterStride<>(stride));
      below.transposeInPlace();
      Block(p + j + i * stride, Eigen::OuterStride<>(stride)) = below;
    }
  }
  const int whole = n - n % 4;
  for (int i = whole; i < n; ++i) {
    for (int c = 0; c < i; ++c) p[c + i * stride] = p[i + c * stride];
  }
}

}  // namespace tenon::stage
