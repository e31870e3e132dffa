// Random numbers that are the same everywhere: the engine is the standard's, the distributions, which the standard leaves open, stand here.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

namespace tenon {

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// In [lower, upper), 53 bits of it random.
  double uniform(double lower, double upper) { return lower + (upper - lower) * static_cast<double>(engine_() >> 11) * 0x1p-53; }

  /// Mean 0, standard deviation 1: Box and Muller's.
  double normal() {
    const double radius = std::sqrt(-2 * std::log(1 - uniform(0, 1)));
    return radius * std::cos(uniform(0, 2 * std::numbers::pi));
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace tenon
