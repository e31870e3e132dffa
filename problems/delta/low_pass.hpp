// A second-order low-pass filter (Butterworth) for three signals at a fixed period. What it remembers is its caller's.
//
//     G(s) = 1 / (1 + sqrt(2) s/w + (s/w)^2),  made discrete by s/w -> (1/k) (z - 1)/(z + 1),  k = tan(w T/2)
#pragma once

#include <cmath>
#include <numbers>

#include "tenon/core/eigen.hpp"

namespace tenon::delta {

class LowPass {
 public:
  /// frequency in Hz, below half of 1/period; period in s. Frequency 0: what goes in comes out.
  LowPass(double frequency, double period) {
    if (frequency == 0) return;
    const double k = std::tan(std::numbers::pi * frequency * period), k2 = k * k, root = std::numbers::sqrt2 * k;
    const double norm = 1 / (1 + root + k2);
    b_ = k2 * norm;
    a1_ = 2 * (k2 - 1) * norm;
    a2_ = (1 - root + k2) * norm;
    passes_ = false;
  }

  struct State {
    Eigen::Vector3d s1{0, 0, 0}, s2{0, 0, 0};
  };

  Eigen::Vector3d operator()(const Eigen::Vector3d& in, State& state) const {
    if (passes_) return in;
    const Eigen::Vector3d out = b_ * in + state.s1;
    state.s1 = 2 * b_ * in - a1_ * out + state.s2;
    state.s2 = b_ * in - a2_ * out;
    return out;
  }

 private:
  double b_ = 1, a1_ = 0, a2_ = 0;
  bool passes_ = true;
};

}  // namespace tenon::delta
