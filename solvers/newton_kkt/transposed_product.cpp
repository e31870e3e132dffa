#include "tenon/solvers/newton_kkt/transposed_product.hpp"

#include <algorithm>
#include <utility>

namespace tenon {

TransposedProduct::TransposedProduct(const SparsePattern& jacobian) {
  std::vector<std::size_t> open, opened;  // blocks that the column before, and this one, belong to
  for (int column = 0; column < jacobian.cols; ++column) {
    opened.clear();
    const int end = jacobian.outer[column + 1];
    for (int source = jacobian.outer[column], rows; source < end; source += rows) {
      const int row = jacobian.inner[source];
      for (rows = 1; source + rows < end && jacobian.inner[source + rows] == row + rows;) ++rows;
      const auto same = [&](std::size_t b) {
        const Block& block = blocks_[b];
        return block.row == row && block.rows == rows && (block.columns == 1 || block.source + block.columns * block.stride == source);
      };
      const auto found = std::ranges::find_if(open, same);
      if (found == open.end()) {
        opened.push_back(blocks_.size());
        blocks_.push_back({row, rows, column, 1, source, 0});
      } else {
        Block& block = blocks_[*found];
        if (block.columns++ == 1) block.stride = source - block.source;
        opened.push_back(*found);
      }
    }
    std::swap(open, opened);
  }
  std::erase_if(blocks_, [&](const Block& block) {
    if (block.rows > 1 || block.columns > 1) return false;
    entries_.push_back({block.row, block.column, block.source});
    return true;
  });
}

}  // namespace tenon
