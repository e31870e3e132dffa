#include "tenon/problems/pushed_block/script.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tenon::pushed_block {

namespace {

constexpr double kPole = 25;    // 1/s: of the loop, both poles
constexpr double kShare = 0.5;  // of what is new in the rate

}  // namespace

void PushScript::reset() {
  last_ = rate_ = 0;
  has_last_ = false;
}

void PushScript::update(double t, ConstVectorRef measurements, VectorRef commands) {
  const double x = measurements[0], m = parameters_.finger_mass;
  if (has_last_) rate_ += kShare * ((x - last_) / parameters_.period - rate_);
  last_ = x;
  has_last_ = true;

  double r = 0, r_rate = 0, r_acceleration = 0;
  if (path_.moves && t > path_.start) {
    const double since = t - path_.start, omega = 2 * std::numbers::pi * path_.frequency;
    r = path_.speed * (since + path_.depth * (1 - std::cos(omega * since)) / omega);
    r_rate = path_.speed * (1 + path_.depth * std::sin(omega * since));
    r_acceleration = path_.speed * path_.depth * omega * std::cos(omega * since);
  }
  commands[0] = m * (r_acceleration + 2 * kPole * (r_rate - rate_) + kPole * kPole * (r - x));
}

}  // namespace tenon::pushed_block
