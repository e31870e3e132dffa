// An encoder: a turn in 2^bits steps.
#pragma once

#include <cmath>
#include <numbers>

namespace tenon::delta {

/// The angle (rad) as an encoder of so many bits reads it; 0 bits: exactly.
inline double quantised(double angle, int bits) {
  if (bits == 0) return angle;
  const double step = 2 * std::numbers::pi / std::ldexp(1.0, bits);
  return std::round(angle / step) * step;
}

}  // namespace tenon::delta
