#include "tenon/problems/envelope/rotor_reach.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "tenon/problems/allocation/inverse_throttle_map.hpp"

namespace tenon {

namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;
constexpr int kSteps = 64;            // of the throttle, where a map is looked at
constexpr double kLeastLength = 1e-9;  // of y, where a direction is needed
constexpr double kRounding = 1e-12;

/// w(m, t; d) = [ m d ; m (r x d) + s t d ]
Wrench wrench_of(const Rotor& rotor, double thrust, double torque, const Eigen::Vector3d& d) {
  Wrench w;
  w << thrust * d, thrust * rotor.position.cross(d) + rotor.spin * torque * d;
  return w;
}

std::vector<double> derivative(const std::vector<double>& coefficients) {
  std::vector<double> out{0};
  for (std::size_t k = 1; k < coefficients.size(); ++k) {
    out.resize(k);
    out[k - 1] = static_cast<double>(k) * coefficients[k];
  }
  return out;
}

/// Calls f at evenly spaced throttles, both ends included.
template <class F>
void over_throttles(const Rotor& rotor, F&& f) {
  for (int k = 0; k <= kSteps; ++k) f(rotor.throttle_lower + (rotor.throttle_upper - rotor.throttle_lower) * k / kSteps);
}

}  // namespace

RotorReach::RotorReach(const Rotor& rotor) : rotor_(rotor), slope_(derivative(rotor.thrust)) {
  const double least = thrust(rotor.throttle_lower), most = thrust(rotor.throttle_upper);
  largest_ = std::max(std::abs(least), std::abs(most));
  const double full = std::abs(most) >= std::abs(least) ? rotor.throttle_upper : rotor.throttle_lower;
  torque_ratio_ = throttle_map(rotor.torque, full) / thrust(full);
  is_linear_ = rotor.thrust[0] == 0 && std::all_of(slope_.begin() + 1, slope_.end(), [](double c) { return c == 0; });
  if (!rises(rotor.thrust, rotor.throttle_lower, rotor.throttle_upper)) deviation_ = std::numeric_limits<double>::infinity();

  double torque = 0, miss = 0;
  over_throttles(rotor, [&](double u) {
    torque = std::max(torque, std::abs(throttle_map(rotor.torque, u)));
    miss = std::max(miss, std::abs(throttle_map(rotor.torque, u) - torque_ratio_ * thrust(u)));
  });
  is_proportional_ = miss <= kRounding * torque;
  if (!is_proportional_) deviation_ = std::max(deviation_, miss / torque);

  columns_.setZero();
  if (!rotor.tilt) {
    directions_[0] = rotor.zero;
    directions_[1] = directions_[2] = Eigen::Vector3d::Zero();
    columns_.col(0) = largest_ * wrench_of(rotor, 1, torque_ratio_, rotor.zero);
    along_.setZero();
    limits_[num_limits_++] = {.b = -least / largest_, .a = {1, 0}};
    limits_[num_limits_++] = {.b = most / largest_, .a = {-1, 0}};
    centre_[0] = (least + most) / (2 * largest_);
    is_exact_ = is_proportional_;
    return;
  }
  // (1.1)  p_0 = (x.z) x,  p_1 = z - p_0,  p_2 = x x z
  const double along = rotor.axis.dot(rotor.zero);
  directions_[0] = along * rotor.axis;
  directions_[1] = rotor.zero - directions_[0];
  directions_[2] = rotor.axis.cross(rotor.zero);
  for (int k = 0; k < 2; ++k) columns_.col(k) = largest_ * wrench_of(rotor, 1, torque_ratio_, directions_[k + 1]);
  along_ = largest_ * wrench_of(rotor, 1, torque_ratio_, directions_[0]);
  deviation_ = std::max(deviation_, std::abs(along));
  is_exact_ = is_proportional_ && along == 0;

  limits_[num_limits_++] = {.b = 0.5, .c = 1};
  const double span = rotor.angle_upper - rotor.angle_lower;
  if (least > 0 || (span < kTwoPi && (span > std::numbers::pi || least < 0))) deviation_ = std::numeric_limits<double>::infinity();
  if (span <= std::numbers::pi) {
    const double lower = rotor.angle_lower, upper = rotor.angle_upper, middle = (lower + upper) / 2;
    limits_[num_limits_++] = {.a = {-std::sin(lower), std::cos(lower)}};
    limits_[num_limits_++] = {.a = {std::sin(upper), -std::cos(upper)}};
    centre_ = 0.5 * Eigen::Vector2d(std::cos(middle), std::sin(middle));
  }
}

double RotorReach::thrust(double throttle) const {
  return throttle_map(rotor_.thrust, throttle);
}

double RotorReach::throttle_of(double thrust) const {
  if (is_linear_) return thrust / rotor_.thrust[1];
  return inverse_throttle_map(rotor_.thrust, thrust, rotor_.throttle_lower, rotor_.throttle_upper);
}

RotorReach::Effort RotorReach::effort(const Eigen::Vector2d& y) const {
  // psi(v) = u(M v)^2,    psi' = 2 M u/mu',    psi'' = 2 M^2 (1 - u mu''/mu')/mu'^2
  const double v = rotor_.tilt ? std::max(y.norm(), kLeastLength) : y[0];
  const double u = throttle_of(largest_ * v), slope = throttle_map(slope_, u), curvature = throttle_map_slope(slope_, u);
  const double first = 2 * largest_ * u / slope;
  const double second = std::max(0.0, 2 * largest_ * largest_ * (1 - u * curvature / slope) / (slope * slope));
  if (!rotor_.tilt) return {{first, 0}, {1, 0}, second, 0};
  const Eigen::Vector2d ahead = y / v;
  return {first * ahead, ahead, second, first / v};
}

Wrench RotorReach::miss(const Eigen::Vector2d& y) const {
  if (is_exact_) return Wrench::Zero();
  const double v = rotor_.tilt ? y.norm() : y[0];
  Wrench e = v * along_;
  if (!is_proportional_) {
    const double u = throttle_of(largest_ * v);
    const Eigen::Vector3d n = directions_[0] + (directions_[1] * y[0] + directions_[2] * y[1]) / std::max(std::abs(v), kLeastLength);
    e.tail<3>() += rotor_.spin * (throttle_map(rotor_.torque, u) - torque_ratio_ * largest_ * v) * n;
  }
  return e;
}

RotorReach::Command RotorReach::command(const Eigen::Vector2d& y) const {
  if (!rotor_.tilt) return {std::clamp(throttle_of(largest_ * y[0]), rotor_.throttle_lower, rotor_.throttle_upper), 0};
  const double u = std::clamp(throttle_of(largest_ * y.norm()), rotor_.throttle_lower, rotor_.throttle_upper);
  double a = std::atan2(y[1], y[0]);
  if (std::isfinite(rotor_.angle_lower)) a += kTwoPi * std::ceil((rotor_.angle_lower - a) / kTwoPi - 1e-9);
  if (std::isfinite(rotor_.angle_upper)) a -= kTwoPi * std::ceil((a - rotor_.angle_upper) / kTwoPi - 1e-9);
  return {u, std::clamp(a, rotor_.angle_lower, rotor_.angle_upper)};
}

double RotorReach::support_at(double throttle, const Wrench& normal) const {
  const double m = thrust(throttle), t = throttle_map(rotor_.torque, throttle);
  const auto share = [&](int k) { return normal.dot(wrench_of(rotor_, m, t, directions_[k])); };
  if (!rotor_.tilt) return share(0);
  const double c = share(1), s = share(2), best = std::atan2(s, c);
  const double turns = std::floor((rotor_.angle_upper - best) / kTwoPi);
  if (!std::isfinite(turns) || best + kTwoPi * turns >= rotor_.angle_lower) return share(0) + std::hypot(c, s);
  const auto at = [&](double a) { return c * std::cos(a) + s * std::sin(a); };
  return share(0) + std::max(at(rotor_.angle_lower), at(rotor_.angle_upper));
}

double RotorReach::support(const Wrench& normal) const {
  const double lower = rotor_.throttle_lower, upper = rotor_.throttle_upper;
  double most = std::max(support_at(lower, normal), support_at(upper, normal));
  if (is_proportional_ && std::isfinite(deviation_)) return most;  // linear in the thrust, so that an end of its range is best
  // Else a golden-section search about the best of evenly spaced throttles.
  double best = upper;
  over_throttles(rotor_, [&](double u) {
    if (const double value = support_at(u, normal); value > most) most = value, best = u;
  });
  double low = std::max(lower, best - (upper - lower) / kSteps), high = std::min(upper, best + (upper - lower) / kSteps);
  for (int k = 0; k < 40; ++k) {
    const double ratio = 1 / std::numbers::phi, left = high - ratio * (high - low), right = low + ratio * (high - low);
    const double at_left = support_at(left, normal), at_right = support_at(right, normal);
    (at_left > at_right ? high : low) = at_left > at_right ? right : left;
    most = std::max({most, at_left, at_right});
  }
  return most;
}

}  // namespace tenon
