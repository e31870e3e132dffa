#include "tenon/solvers/newton_kkt/subtract_product.hpp"

#include "tenon/solvers/newton_kkt/lanes.hpp"

namespace tenon {
namespace {

using Lane = lanes::Lane<double>;
using LooseMap = Eigen::Map<Lane>;
using LooseConstMap = Eigen::Map<const Lane>;

// One tile of c, in registers: Lanes * 4 rows, Columns columns.
template <int Lanes, int Columns>
inline void subtract_tile(const double* l, const double* w, std::ptrdiff_t stride, int depth, double* c, std::ptrdiff_t c_stride) {
  Lane sum[Columns][Lanes];
  for (auto& column : sum) {
    for (Lane& lane : column) lane.setZero();
  }
  for (int k = 0; k < depth; ++k, l += stride, w += stride) {
    Lane left[Lanes];
    for (int q = 0; q < Lanes; ++q) left[q] = LooseConstMap(l + 4 * q);
    for (int j = 0; j < Columns; ++j) {
      for (int q = 0; q < Lanes; ++q) sum[j][q] += left[q] * w[j];
    }
  }
  for (int j = 0; j < Columns; ++j) {
    for (int q = 0; q < Lanes; ++q) LooseMap(c + j * c_stride + 4 * q) -= sum[j][q];
  }
}

template <int Columns>
void subtract_columns(const double* l, const double* w, std::ptrdiff_t stride, int depth, double* c, std::ptrdiff_t c_stride, int rows) {
  int i = 0;
  for (; i + 8 <= rows; i += 8) subtract_tile<2, Columns>(l + i, w, stride, depth, c + i, c_stride);
  for (; i + 4 <= rows; i += 4) subtract_tile<1, Columns>(l + i, w, stride, depth, c + i, c_stride);
  for (; i < rows; ++i) {
    for (int j = 0; j < Columns; ++j) {
      double sum = 0;
      for (int k = 0; k < depth; ++k) sum += l[k * stride + i] * w[k * stride + j];
      c[j * c_stride + i] -= sum;
    }
  }
}

}  // namespace

void subtract_product(const double* l, const double* w, int stride, int depth, double* c, int c_stride, int columns, int rows) {
  int j = 0;
  for (; j + 4 <= columns; j += 4) {
    subtract_columns<4>(l + j, w + j, stride, depth, c + static_cast<std::ptrdiff_t>(j) * c_stride + j, c_stride, rows - j);
  }
  for (; j < columns; ++j) {
    subtract_columns<1>(l + j, w + j, stride, depth, c + static_cast<std::ptrdiff_t>(j) * c_stride + j, c_stride, rows - j);
  }
}

}  // namespace tenon
