// The box l <= v <= u of a vector, seen by the barrier: slack distances, multipliers, and what both add to the Newton system.
//
//     barrier gradient   -mu/(v - l) + mu/(u - v)            stiffness   Sigma = z_l/(v - l) + z_u/(u - v)
//
// An absent bound is infinite and every quotient with it is 0, so no case is told apart in the loops. An entry with l == u is fixed: it
// has no barrier and a stiffness of 1e30, which keeps its step at 0 without changing any structure.
#pragma once

#include <algorithm>
#include <cmath>

#include "tenon/core/nlp.hpp"

namespace tenon {

inline constexpr double kFixedStiffness = 1e30;

/// Multipliers of the two sides of a box, both >= 0.
template <class Scalar, int Dim>
struct BoxMultipliers {
  Eigen::Array<Scalar, Dim, 1> lower, upper;
};

template <class Scalar, int Dim>
class BarrierBox {
 public:
  using Array = Eigen::Array<Scalar, Dim, 1>;
  using Multipliers = BoxMultipliers<Scalar, Dim>;

  explicit BarrierBox(int size) : lower_(size), upper_(size), lowest_(size), highest_(size), fixed_(size), free_(size) {}

  /// Takes the bounds and moves v to fixed values.
  void set(const auto& lower, const auto& upper, auto&& v) {
    sides_ = 0;
    any_fixed_ = false;
    for (Eigen::Index i = 0; i < v.size(); ++i) {
      const bool fixed = std::isfinite(lower[i]) && upper[i] - lower[i] <= 4 * margin(lower[i]);  // no room for an interior
      fixed_[i] = fixed ? Scalar(kFixedStiffness) : Scalar(0);
      free_[i] = fixed ? Scalar(0) : Scalar(1);
      lower_[i] = fixed ? -kInfinity<Scalar> : lower[i];
      upper_[i] = fixed ? kInfinity<Scalar> : upper[i];
      if (fixed) v[i] = lower[i];
      lowest_[i] = std::isfinite(lower_[i]) ? lower_[i] + margin(lower_[i]) : lower_[i];
      highest_[i] = std::isfinite(upper_[i]) ? upper_[i] - margin(upper_[i]) : upper_[i];
      any_fixed_ |= fixed;
      sides_ += int(std::isfinite(lower_[i])) + int(std::isfinite(upper_[i]));
    }
  }

  /// Number of finite sides; 0 means that there is no barrier at all.
  int sides() const { return sides_; }
  bool any_fixed() const { return any_fixed_; }
  const Array& fixed_stiffness() const { return fixed_; }
  const Array& free_mask() const { return free_; }  // 0 where fixed, else 1

  /// Undoes what rounding may do to a step up to the boundary: every distance stays positive.
  void keep_inside(auto&& v) const {
    if (sides_ > 0) v = v.max(lowest_).min(highest_);
  }

  /// Moves v into the interior, at least `absolute` max(1, |bound|) away from a bound, or `relative` of the width.  [WB06, sec. 3.6]
  void push_inside(auto&& v, Scalar absolute, Scalar relative) const {
    if (sides_ == 0) return;
    for (Eigen::Index i = 0; i < v.size(); ++i) {
      const Scalar width = upper_[i] - lower_[i];
      const Scalar lowest = lower_[i] + std::min(absolute * std::max(Scalar(1), std::abs(lower_[i])), relative * width);
      const Scalar highest = upper_[i] - std::min(absolute * std::max(Scalar(1), std::abs(upper_[i])), relative * width);
      if (std::isfinite(lower_[i]) && v[i] < lowest) v[i] = lowest;
      if (std::isfinite(upper_[i]) && v[i] > highest) v[i] = highest;
    }
  }

  /// All multipliers of finite sides = value.
  void fill(Multipliers& z, Scalar value) const {
    z.lower = (lower_ > -kInfinity<Scalar>).select(Array::Constant(lower_.size(), value), Scalar(0));
    z.upper = (upper_ < kInfinity<Scalar>).select(Array::Constant(upper_.size(), value), Scalar(0));
  }

  /// Multipliers of a warm start: the given signed ones, and at least mu / distance, so that no product lies below mu.
  void split(const auto& v, const auto& signed_multiplier, Scalar mu, Multipliers& z) const {
    z.lower = (-signed_multiplier).max(mu / (v - lower_));
    z.upper = signed_multiplier.max(mu / (upper_ - v));
    z.lower = (lower_ > -kInfinity<Scalar>).select(z.lower, Scalar(0));
    z.upper = (upper_ < kInfinity<Scalar>).select(z.upper, Scalar(0));
  }

  /// Multipliers on the central path: every product = mu.
  void centre(const auto& v, Scalar mu, Multipliers& z) const {
    if (sides_ == 0) return;
    z.lower = mu / (v - lower_);
    z.upper = mu / (upper_ - v);
  }

  /// Sigma, the fixed entries' stiffness included.
  void stiffness(const auto& v, const Multipliers& z, auto&& sigma) const {
    if (sides_ == 0) sigma = fixed_;
    else sigma = z.lower / (v - lower_) + z.upper / (upper_ - v) + fixed_;
  }

  /// gradient += -mu/(v - l) + mu/(u - v)
  void add_barrier_gradient(const auto& v, Scalar mu, auto&& gradient) const {
    if (sides_ > 0) gradient += mu / (upper_ - v) - mu / (v - lower_);
  }

  /// Derivative of -mu (sum of logarithms) along dv.
  Scalar barrier_slope(const auto& v, const auto& dv, Scalar mu) const {
    if (sides_ == 0) return 0;
    return mu * (dv / (upper_ - v) - dv / (v - lower_)).sum();
  }

  /// sum of log(v - l) + log(u - v). One logarithm for many factors: they are multiplied up while the product stays in range.
  Scalar log_barrier(const auto& v) const {
    if (sides_ == 0) return 0;
    Scalar sum = 0, product = 1;
    const auto multiply = [&](Scalar distance) {
      product *= distance;
      if (!(product > Scalar(kSmallest) && product < Scalar(kLargest))) {
        sum += std::log(product);
        product = 1;
      }
    };
    for (Eigen::Index i = 0; i < v.size(); ++i) {
      if (lower_[i] > -kInfinity<Scalar>) multiply(v[i] - lower_[i]);
      if (upper_[i] < kInfinity<Scalar>) multiply(upper_[i] - v[i]);
    }
    return sum + std::log(product);
  }

  /// dz of both sides for the step dv:  dz_l = mu/(v-l) - z_l - z_l/(v-l) dv,   dz_u = mu/(u-v) - z_u + z_u/(u-v) dv.
  void multiplier_step(const auto& v, const Multipliers& z, const auto& dv, Scalar mu, Multipliers& dz) const {
    if (sides_ == 0) return;
    dz.lower = (mu - z.lower * dv) / (v - lower_) - z.lower;
    dz.upper = (mu + z.upper * dv) / (upper_ - v) - z.upper;
  }

  /// Fraction to the boundary: the largest a in (0, 1] with v + a dv at least (1 - tau) of its distance away from every bound.
  Scalar max_step(const auto& v, const auto& dv, Scalar tau) const {
    if (sides_ == 0) return 1;
    // a (-dv) <= tau (v - l)  and  a dv <= tau (u - v):  1/a is the largest quotient
    const Scalar inverse = (dv / (upper_ - v)).max(-dv / (v - lower_)).maxCoeff();
    return inverse > tau ? tau / inverse : Scalar(1);
  }

  Scalar max_multiplier_step(const Multipliers& z, const Multipliers& dz, Scalar tau) const {
    if (sides_ == 0) return 1;
    Scalar inverse = tau;
    for (Eigen::Index i = 0; i < z.lower.size(); ++i) {
      if (-dz.lower[i] > inverse * z.lower[i] && z.lower[i] > 0) inverse = -dz.lower[i] / z.lower[i];
      if (-dz.upper[i] > inverse * z.upper[i] && z.upper[i] > 0) inverse = -dz.upper[i] / z.upper[i];
    }
    return inverse > tau ? tau / inverse : Scalar(1);
  }

  /// Keeps every product within [mu/kappa, kappa mu], kappa = 1e10.  [WB06, eq. 16]
  void safeguard(const auto& v, Scalar mu, Multipliers& z) const {
    if (sides_ == 0) return;
    const Scalar kappa = Scalar(1e10);
    z.lower = z.lower.min(kappa * mu / (v - lower_)).max(mu / (kappa * (v - lower_)));
    z.upper = z.upper.min(kappa * mu / (upper_ - v)).max(mu / (kappa * (upper_ - v)));
  }

  /// Largest |product - mu|.
  Scalar complementarity(const auto& v, const Multipliers& z, Scalar mu) const {
    Scalar largest = 0;
    if (sides_ == 0) return largest;
    for (Eigen::Index i = 0; i < v.size(); ++i) {
      if (lower_[i] > -kInfinity<Scalar>) largest = std::max(largest, std::abs(z.lower[i] * (v[i] - lower_[i]) - mu));
      if (upper_[i] < kInfinity<Scalar>) largest = std::max(largest, std::abs(z.upper[i] * (upper_[i] - v[i]) - mu));
    }
    return largest;
  }

  Scalar sum_of_products(const auto& v, const Multipliers& z) const {
    Scalar sum = 0;
    if (sides_ == 0) return sum;
    for (Eigen::Index i = 0; i < v.size(); ++i) {
      if (lower_[i] > -kInfinity<Scalar>) sum += z.lower[i] * (v[i] - lower_[i]);
      if (upper_[i] < kInfinity<Scalar>) sum += z.upper[i] * (upper_[i] - v[i]);
    }
    return sum;
  }

 private:
  static constexpr double kSmallest = sizeof(Scalar) == 8 ? 1e-250 : 1e-30;
  static constexpr double kLargest = sizeof(Scalar) == 8 ? 1e250 : 1e30;

  static Scalar margin(Scalar bound) { return 4 * std::numeric_limits<Scalar>::epsilon() * std::max(Scalar(1), std::abs(bound)); }

  Array lower_, upper_;
  Array lowest_, highest_;  // the same, a few units of rounding inside
  Array fixed_;             // 0, or kFixedStiffness
  Array free_;              // 1, or 0
  int sides_ = 0;
  bool any_fixed_ = false;
};

}  // namespace tenon
