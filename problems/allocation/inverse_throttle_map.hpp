// The throttle that gives a thrust: the inverse of a map that rises.
#pragma once

#include <algorithm>
#include <cmath>

#include "tenon/problems/allocation/throttle_map.hpp"

namespace tenon {

/// Solves map(u) = value on [lower, upper] for a map that rises there; Newton's steps, bisected where they leave the bracket. What lies beyond
/// the ends of the map gives the nearer one.
inline double inverse_throttle_map(std::span<const double> coefficients, double value, double lower, double upper) {
  double u = lower + (upper - lower) / 2;
  for (int k = 0; k < 100; ++k) {
    const double error = throttle_map(coefficients, u) - value;
    if (error == 0) return u;
    (error < 0 ? lower : upper) = u;
    double next = u - error / throttle_map_slope(coefficients, u);
    if (!(next > lower && next < upper)) next = lower + (upper - lower) / 2;
    if (std::abs(next - u) <= 1e-16 * std::max(1.0, std::abs(u))) return next;
    u = next;
  }
  return u;
}

}  // namespace tenon
