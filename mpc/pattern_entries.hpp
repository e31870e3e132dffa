// The entries of a sparse pattern, in its order.
#pragma once

#include <cstddef>

#include "tenon/core/sparse_pattern.hpp"

namespace tenon {

/// entry(row, column, position)
template <class Entry>
void for_each_entry(const SparsePattern& pattern, Entry&& entry) {
  for (int c = 0; c < pattern.cols; ++c) {
    for (int e = pattern.outer[static_cast<std::size_t>(c)]; e < pattern.outer[static_cast<std::size_t>(c) + 1]; ++e)
      entry(pattern.inner[static_cast<std::size_t>(e)], c, static_cast<std::size_t>(e));
  }
}

}  // namespace tenon
