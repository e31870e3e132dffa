// C <- C - L W', the lower part of a symmetric product: where most of the arithmetic of a large factorisation is done.
#pragma once

namespace tenon {

/// c(i, j) -= sum_k l(i, k) w(j, k)  for j < columns, j <= i < rows, k < depth; column-major, l and w share a stride. Entries of c above
/// the diagonal may change.
void subtract_product(const double* l, const double* w, int stride, int depth, double* c, int c_stride, int columns, int rows);

}  // namespace tenon
