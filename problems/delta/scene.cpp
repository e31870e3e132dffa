#include "tenon/problems/delta/scene.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tenon::delta {

double Gripper::opening(double t) const {
  if (end <= begin) return from;
  return from + (to - from) * std::clamp((t - begin) / (end - begin), 0.0, 1.0);
}

double Push::phase(double t) const {
  // 2 pi f_0 T/ln(f_1/f_0) ((f_1/f_0)^(t/T) - 1)
  const double ratio = std::log(to / from), turns = ratio == 0 ? from * t : from * duration / ratio * std::expm1(ratio * t / duration);
  return 2 * std::numbers::pi * turns;
}

Vector3 Push::at(double t) const {
  return amplitude.isZero() ? constant : Vector3(constant + amplitude * std::sin(phase(t)));
}

}  // namespace tenon::delta
