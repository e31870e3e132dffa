// The barrier parameter mu and its way to 0: monotone, superlinear at the end.  [WB06, eq. 7, 8]
#pragma once

#include <algorithm>
#include <cmath>

namespace tenon {

template <class Scalar>
class BarrierParameter {
 public:
  /// The smallest mu: products of it still meet the tolerance.
  void start(Scalar initial, Scalar tolerance) {
    smallest_ = tolerance / (kKappaEpsilon + 1);
    mu_ = std::max(initial, smallest_);
  }

  /// No bounds: no barrier.
  void switch_off() { mu_ = smallest_ = 0; }

  Scalar value() const { return mu_; }
  bool at_end() const { return mu_ <= smallest_; }

  /// The barrier problem of this mu counts as solved at an error of kappa_epsilon mu.
  bool solved(Scalar error) const { return error <= kKappaEpsilon * mu_; }

  void decrease() { mu_ = std::max(smallest_, std::min(kKappaMu * mu_, std::pow(mu_, kThetaMu))); }

  /// Fraction to the boundary.
  Scalar tau() const { return std::max(Scalar(0.99), 1 - mu_); }

  static constexpr Scalar kInitial = Scalar(0.1);

 private:
  static constexpr Scalar kKappaEpsilon = 10, kKappaMu = Scalar(0.2), kThetaMu = Scalar(1.5);

  Scalar mu_ = 0, smallest_ = 0;
};

}  // namespace tenon
