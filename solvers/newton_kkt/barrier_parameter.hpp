// The barrier parameter mu and its way to 0, in two gaits.
//
//     free       at each iterate anew, from how far the affine step (mu = 0) gets:  mu = (gap_affine / gap)^3 gap         [Meh92], [NWW09]
//     monotone   the next, smaller mu as soon as the barrier problem of this one is solved, superlinear at the end        [WB06, eq. 7, 8]
//
// Free is faster but promises nothing: it goes on while the error is below the worst of the last four, and is taken up again when it is below
// the best of all.
//
// [Meh92] S. Mehrotra, On the implementation of a primal-dual interior point method, SIAM J. Optim. 2 (1992).
// [NWW09] J. Nocedal, A. Waechter, R. A. Waltz, Adaptive barrier update strategies for nonlinear interior methods, SIAM J. Optim. 19 (2009).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tenon {

template <class Scalar>
class BarrierParameter {
 public:
  /// The smallest mu: products of it still meet the tolerance.
  void start(Scalar initial, Scalar tolerance) {
    smallest_ = tolerance / (kKappaEpsilon + 1);
    mu_ = std::max(initial, smallest_);
    free_ = true;
    errors_.fill(std::numeric_limits<Scalar>::infinity());
    best_ = std::numeric_limits<Scalar>::infinity();
  }

  /// No bounds: no barrier.
  void switch_off() {
    mu_ = smallest_ = 0;
    free_ = false;
  }

  Scalar value() const { return mu_; }
  bool at_end() const { return mu_ <= smallest_; }
  bool is_free() const { return free_; }

  /// Whether this iterate's optimality error is good enough for the free gait; if so it is remembered.
  bool falls(Scalar error) {
    if (!(error <= kFall * (free_ ? *std::max_element(errors_.begin(), errors_.end()) : best_))) return false;
    errors_[seen_++ % errors_.size()] = error;
    best_ = std::min(best_, error);
    return true;
  }

  /// Free: mu for products whose mean is `gap` now and would be `affine` after the affine step, but not below `least` without need.
  void choose(Scalar gap, Scalar affine, Scalar least) {
    const Scalar ratio = affine / gap;
    mu_ = std::max({smallest_, std::min(least, gap), std::min(ratio * ratio * ratio, kMaxSigma) * gap});
  }

  /// Walls that close while the violation, or the whole error, is still large leave no way round curved rows.
  Scalar tether(Scalar primal, Scalar error) const {
    return kTether * std::min(kMostTethered, std::max(primal, error * std::sqrt(error)));
  }

  /// Free, where all products are about the smallest mu: no affine step is needed to choose.
  bool has_arrived(Scalar gap) const { return gap <= kKappaEpsilon * smallest_; }
  void choose_smallest() { mu_ = smallest_; }

  void go_monotone(Scalar gap) {
    free_ = false;
    mu_ = std::max(smallest_, kHold * gap);
  }
  void go_free() { free_ = true; }

  /// Monotone: the barrier problem of this mu counts as solved at an error of kappa_epsilon mu.
  bool solved(Scalar error) const { return error <= kKappaEpsilon * mu_; }
  void decrease() { mu_ = std::max(smallest_, std::min(kKappaMu * mu_, std::pow(mu_, kThetaMu))); }

  /// Fraction to the boundary.
  Scalar tau() const { return std::max(Scalar(0.99), 1 - mu_); }

  static constexpr Scalar kInitial = Scalar(0.1);

 private:
  static constexpr Scalar kKappaEpsilon = 10, kKappaMu = Scalar(0.2), kThetaMu = Scalar(1.5);
  static constexpr Scalar kFall = Scalar(0.9999), kHold = Scalar(0.8), kMaxSigma = 100;
  static constexpr Scalar kTether = Scalar(0.01), kMostTethered = 10;

  Scalar mu_ = 0, smallest_ = 0;
  bool free_ = false;
  std::array<Scalar, 4> errors_{};  // of the last iterates that fell
  Scalar best_ = 0;
  std::size_t seen_ = 0;
};

}  // namespace tenon
