// Scales by powers of two: they equilibrate a matrix without a rounding, and cost integer arithmetic only.
//
//     (1.2)  s_i <- s_i / sqrt(max_j |s_i K_ij s_j|), all rows at once, a few times over: the largest entry of every row tends to 1.
//
// Source: Ruiz, "A scaling algorithm to equilibrate both rows and columns norms in matrices", RAL-TR-2001-034.
#pragma once

#include <bit>
#include <cstdint>

namespace tenon {

/// The power of two nearest below 2 / sqrt(x), x >= 0: between 1 / sqrt(x) and 2 / sqrt(x); 1 for x = 0, a row without entries.
inline double inverse_root_scale(double x) {
  const auto exponent = static_cast<std::int64_t>(std::bit_cast<std::uint64_t>(x) >> 52) - 1023;
  const auto scale = static_cast<std::uint64_t>(1023 - (exponent >> 1)) << 52;
  return x > 0 ? std::bit_cast<double>(scale) : 1.0;
}

inline float inverse_root_scale(float x) {
  const auto exponent = static_cast<std::int32_t>(std::bit_cast<std::uint32_t>(x) >> 23) - 127;
  const auto scale = static_cast<std::uint32_t>(127 - (exponent >> 1)) << 23;
  return x > 0 ? std::bit_cast<float>(scale) : 1.0f;
}

}  // namespace tenon
