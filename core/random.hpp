// Random numbers that are the same everywhere: the engine is the standard's, the distributions, which the standard leaves open, stand here.
#pragma once

#include <cstdint>
#include <random>

namespace tenon {

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// In [lower, upper), 53 bits of it random.
  double uniform(double lower, double upper) { return lower + (upper - lower) * static_cast<double>(engine_() >> 11) * 0x1p-53; }

 private:
  std::mt19937_64 engine_;
};

}  // namespace tenon
