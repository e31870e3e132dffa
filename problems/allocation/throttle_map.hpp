// Thrust and torque maps: polynomials in the throttle, ascending coefficients, by Horner's scheme.
#pragma once

#include <span>

namespace tenon {

inline double throttle_map(std::span<const double> coefficients, double u) {
  double value = 0;
  for (std::size_t k = coefficients.size(); k-- > 0;) value = value * u + coefficients[k];
  return value;
}

inline double throttle_map_slope(std::span<const double> coefficients, double u) {
  double slope = 0;
  for (std::size_t k = coefficients.size(); k-- > 1;) slope = slope * u + static_cast<double>(k) * coefficients[k];
  return slope;
}

/// False where the map falls somewhere on [lower, upper], looked at in 1000 steps.
inline bool rises(std::span<const double> coefficients, double lower, double upper) {
  constexpr int kSteps = 1000;
  double last = throttle_map(coefficients, lower);
  for (int k = 1; k <= kSteps; ++k) {
    const double value = throttle_map(coefficients, lower + (upper - lower) * k / kSteps);
    if (value < last) return false;
    last = value;
  }
  return true;
}

}  // namespace tenon
