// Random numbers that depend on a seed and an instant alone: a simulation that goes back draws the same again.
//
// splitmix64 [Steele, Lea, Flood 2014] from a state made of both; normal numbers after Box and Muller. The same on every machine.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "tenon/core/eigen.hpp"

namespace tenon::flight {

class Noise {
 public:
  Noise(std::uint64_t seed, std::uint64_t instant) : state_(seed) {
    state_ = next() + instant;
    state_ = next();
  }

  /// In (0, 1].
  double uniform() { return (static_cast<double>(next() >> 11) + 1) * 0x1p-53; }
  double normal() {
    const double radius = std::sqrt(-2 * std::log(uniform()));
    return radius * std::cos(2 * std::numbers::pi * uniform());
  }
  /// Three independent normal numbers.
  Eigen::Vector3d normal3() {
    const double x = normal(), y = normal();
    return {x, y, normal()};
  }

 private:
  std::uint64_t next() {
    std::uint64_t z = state_ += 0x9E3779B97F4A7C15;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EB;
    return z ^ (z >> 31);
  }

  std::uint64_t state_;
};

}  // namespace tenon::flight
