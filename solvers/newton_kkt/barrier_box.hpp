// The box l <= v <= u of a vector, seen by the barrier from the point where it stands: distances, multipliers, and what both add to the
// Newton system.
//
//     barrier gradient   -mu/(v - l) + mu/(u - v)            stiffness   Sigma = z_l/(v - l) + z_u/(u - v)
//
// The distances and their reciprocals are taken once for each point; both are 0 for an absent bound, so that no case is told apart in the
// loops and all of them run in vector registers. An entry with l == u is fixed: it has no barrier and a stiffness of 1e30, which keeps its
// step at 0 without changing any structure.
#pragma once

#include <algorithm>
#include <cmath>

#include "tenon/core/nlp.hpp"

namespace tenon {

inline constexpr double kFixedStiffness = 1e30;

/// A value for each of the two sides of a box: its multipliers (both >= 0), or its barrier parameters.
template <class Scalar, int Dim>
struct BoxSides {
  Eigen::Array<Scalar, Dim, 1> lower, upper;
};

template <class Scalar, int Dim>
class BarrierBox {
 public:
  using Array = Eigen::Array<Scalar, Dim, 1>;
  using Sides = BoxSides<Scalar, Dim>;

  explicit BarrierBox(int size) : lower_(size), upper_(size), lowest_(size), highest_(size), fixed_(size), free_(size) {
    for (Sides* sides : {&finite_, &anchor_, &distance_, &reciprocal_}) sides->lower.setZero(size), sides->upper.setZero(size);
  }

  /// Takes the bounds and moves v to fixed values.
  void set(const auto& lower, const auto& upper, auto&& v) {
    const auto is_finite = [](Scalar bound) { return std::abs(bound) < kInfinity<Scalar>; };
    sides_ = 0;
    any_fixed_ = false;
    for (Eigen::Index i = 0; i < v.size(); ++i) {
      const bool fixed = is_finite(lower[i]) && upper[i] - lower[i] <= 4 * margin(lower[i]);  // no room for an interior
      const bool below = is_finite(lower[i]) && !fixed, above = is_finite(upper[i]) && !fixed;
      fixed_[i] = fixed ? Scalar(kFixedStiffness) : Scalar(0);
      free_[i] = fixed ? Scalar(0) : Scalar(1);
      lower_[i] = fixed ? -kInfinity<Scalar> : lower[i];
      upper_[i] = fixed ? kInfinity<Scalar> : upper[i];
      v[i] = fixed ? lower[i] : v[i];
      finite_.lower[i] = below ? Scalar(1) : Scalar(0);
      finite_.upper[i] = above ? Scalar(1) : Scalar(0);
      anchor_.lower[i] = below ? lower[i] : Scalar(0);
      anchor_.upper[i] = above ? upper[i] : Scalar(0);
      lowest_[i] = below ? lower[i] + margin(lower[i]) : -kInfinity<Scalar>;
      highest_[i] = above ? upper[i] - margin(upper[i]) : kInfinity<Scalar>;
      any_fixed_ |= fixed;
      sides_ += int(below) + int(above);
    }
    if (sides_ == 0) reciprocal_.lower.setZero(), reciprocal_.upper.setZero();  // of the solve before, which may have had some
  }

  /// Number of finite sides; 0 means that there is no barrier at all.
  int sides() const { return sides_; }
  bool any_fixed() const { return any_fixed_; }
  const Array& fixed_stiffness() const { return fixed_; }
  const Array& free_mask() const { return free_; }  // 0 where fixed, else 1

  // --- points -------------------------------------------------------------------------------------------------------------------------------

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

  /// sum of log(v - l) + log(u - v). One logarithm for many factors: they are multiplied up while the product stays in range.
  Scalar log_barrier(const auto& v) const {
    if (sides_ == 0) return 0;
    Scalar sum = 0, product = 1;
    const auto multiply = [&](Scalar factor) {
      product *= factor;
      if (!(product > Scalar(kSmallest) && product < Scalar(kLargest))) {
        sum += std::log(product);
        product = 1;
      }
    };
    // an absent side has the factor 1
    const auto factors = [&](auto from, auto size) {
      const auto part = [&](const auto& array) { return array.segment(from, size); };
      return ((part(v) - part(anchor_.lower)) * part(finite_.lower) + (1 - part(finite_.lower))) *
             ((part(anchor_.upper) - part(v)) * part(finite_.upper) + (1 - part(finite_.upper)));
    };
    const Eigen::Index size = v.size(), whole = size - size % kLanes;
    for (Eigen::Index i = 0; i < whole; i += kLanes) multiply(factors(i, Eigen::fix<kLanes>).prod());
    for (Eigen::Index i = whole; i < size; ++i) multiply(factors(i, Eigen::fix<1>).prod());
    return sum + std::log(product);
  }

  /// From here on the box is seen from v, which is inside.
  void stand_at(const auto& v) {
    if (sides_ == 0) return;
    distance_.lower = (v - anchor_.lower) * finite_.lower;
    distance_.upper = (anchor_.upper - v) * finite_.upper;
    reciprocal_.lower = finite_.lower / (distance_.lower + (1 - finite_.lower));
    reciprocal_.upper = finite_.upper / (distance_.upper + (1 - finite_.upper));
  }

  // --- multipliers --------------------------------------------------------------------------------------------------------------------------

  /// All multipliers of finite sides = value.
  void fill(Sides& z, Scalar value) const {
    z.lower = value * finite_.lower;
    z.upper = value * finite_.upper;
  }

  /// Multipliers of a warm start: the given signed ones, and at least mu / distance, so that no product lies below mu.
  void split(const auto& signed_multiplier, Scalar mu, Sides& z) const {
    z.lower = finite_.lower * (-signed_multiplier).max(mu * reciprocal_.lower);
    z.upper = finite_.upper * signed_multiplier.max(mu * reciprocal_.upper);
  }

  /// Multipliers on the central path: every product = mu.
  void centre(Scalar mu, Sides& z) const {
    if (sides_ == 0) return;
    z.lower = mu * reciprocal_.lower;
    z.upper = mu * reciprocal_.upper;
  }

  /// Keeps every product within [mu/kappa, kappa mu], kappa = 1e10.  [WB06, eq. 16]
  void safeguard(Scalar mu, Sides& z) const {
    if (sides_ == 0) return;
    const Scalar kappa = Scalar(1e10);
    z.lower = z.lower.min(kappa * mu * reciprocal_.lower).max(mu / kappa * reciprocal_.lower);
    z.upper = z.upper.min(kappa * mu * reciprocal_.upper).max(mu / kappa * reciprocal_.upper);
  }

  /// Largest |product - mu|.
  Scalar complementarity(const Sides& z, Scalar mu) const {
    if (sides_ == 0) return 0;
    return (z.lower * distance_.lower - mu * finite_.lower).abs().max((z.upper * distance_.upper - mu * finite_.upper).abs()).maxCoeff();
  }

  Scalar sum_of_products(const Sides& z) const {
    if (sides_ == 0) return 0;
    return (z.lower * distance_.lower + z.upper * distance_.upper).sum();
  }

  /// The same after a step of length alpha in v and beta in z.
  Scalar sum_of_products_after(const Sides& z, const auto& dv, Scalar alpha, const Sides& dz, Scalar beta) const {
    if (sides_ == 0) return 0;
    // an absent side has z = dz = 0
    return ((distance_.lower + alpha * dv) * (z.lower + beta * dz.lower) + (distance_.upper - alpha * dv) * (z.upper + beta * dz.upper)).sum();
  }

  // --- the Newton system --------------------------------------------------------------------------------------------------------------------

  /// Sigma, the fixed entries' stiffness included.
  void stiffness(const Sides& z, auto&& sigma) const {
    if (sides_ == 0) sigma = fixed_;
    else sigma = z.lower * reciprocal_.lower + z.upper * reciprocal_.upper + fixed_;
  }

  /// -t_l/(v - l) + t_u/(u - v), as an expression; t: the product that each side aims at.
  auto barrier_gradient(const Sides& t) const { return t.upper * reciprocal_.upper - t.lower * reciprocal_.lower; }

  /// t = mu
  void aim_at(Scalar mu, Sides& t) const {
    if (sides_ == 0) return;
    t.lower.setConstant(lower_.size(), mu);
    t.upper.setConstant(upper_.size(), mu);
  }

  /// t = mu - dv dz of the affine step: what its own second-order term leaves is aimed off in advance.  [Meh92]
  void aim_off(Scalar mu, const auto& dv, const Sides& dz, Sides& t) const {
    if (sides_ == 0) return;
    t.lower = mu - dv * dz.lower;
    t.upper = mu + dv * dz.upper;
  }

  /// Derivative of -mu (sum of logarithms) along dv.
  Scalar barrier_slope(const auto& dv, Scalar mu) const {
    if (sides_ == 0) return 0;
    return mu * (dv * (reciprocal_.upper - reciprocal_.lower)).sum();
  }

  /// dz of both sides for the step dv:  dz_l = t_l/(v-l) - z_l - z_l/(v-l) dv,   dz_u = t_u/(u-v) - z_u + z_u/(u-v) dv.
  void multiplier_step(const Sides& z, const auto& dv, const Sides& t, Sides& dz) const {
    if (sides_ == 0) return;
    dz.lower = (t.lower - z.lower * dv) * reciprocal_.lower - z.lower;
    dz.upper = (t.upper + z.upper * dv) * reciprocal_.upper - z.upper;
  }

  /// Fraction to the boundary: the largest a in (0, 1] with v + a dv at least (1 - tau) of its distance away from every bound.
  Scalar max_step(const auto& dv, Scalar tau) const {
    if (sides_ == 0) return 1;
    // a (-dv) <= tau (v - l)  and  a dv <= tau (u - v):  1/a is the largest quotient
    const Scalar inverse = (dv * reciprocal_.upper).max(-dv * reciprocal_.lower).maxCoeff();
    return inverse > tau ? tau / inverse : Scalar(1);
  }

  Scalar max_multiplier_step(const Sides& z, const Sides& dz, Scalar tau) const {
    if (sides_ == 0) return 1;
    // likewise: 1/a is the largest of -dz/z; an absent side has z = dz = 0
    constexpr Scalar kTiny = std::numeric_limits<Scalar>::min();
    const Scalar inverse = (-dz.lower / z.lower.max(kTiny)).max(-dz.upper / z.upper.max(kTiny)).maxCoeff();
    return inverse > tau ? tau / inverse : Scalar(1);
  }

 private:
  static constexpr double kSmallest = sizeof(Scalar) == 8 ? 1e-150 : 1e-20;
  static constexpr double kLargest = sizeof(Scalar) == 8 ? 1e150 : 1e20;
  static constexpr int kLanes = sizeof(Scalar) == 8 ? 4 : 2;  // so many at once leave the range of a product in that of Scalar

  static Scalar margin(Scalar bound) { return 4 * std::numeric_limits<Scalar>::epsilon() * std::max(Scalar(1), std::abs(bound)); }

  Array lower_, upper_;
  Array lowest_, highest_;       // the same, a few units of rounding inside
  Array fixed_;                  // 0, or kFixedStiffness
  Array free_;                   // 1, or 0
  Sides finite_, anchor_;        // 1 and the bound where there is one, else 0
  Sides distance_, reciprocal_;  // of the point where the box is seen from; 0 where there is no bound
  int sides_ = 0;
  bool any_fixed_ = false;
};

}  // namespace tenon
