// Which delta to try next on the Hessian's diagonal, until K = [H + Sigma + delta_w I, J'; J, -D - delta_c I] has n positive and m negative
// eigenvalues: then the step is a descent direction on the null space of J.  [WB06, algorithm IC]
#pragma once

#include <algorithm>

namespace tenon {

template <class Scalar>
class InertiaCorrection {
 public:
  void reset() { last_ = 0; }

  /// The first delta_w to try after delta_w = 0 has failed.
  Scalar first() {
    delta_ = last_ == 0 ? kFirst : std::max(kSmallest, last_ / 3);
    return delta_;
  }

  /// The next one; false when it is beyond reason.
  bool next() {
    delta_ *= last_ == 0 ? Scalar(100) : Scalar(8);
    return delta_ <= kLargest;
  }

  Scalar delta() const { return delta_; }
  void accepted(Scalar delta) {
    if (delta > 0) last_ = delta;
  }

  static constexpr Scalar kFirst = Scalar(1e-4);
  static constexpr Scalar kSmallest = Scalar(1e-20);
  static constexpr Scalar kLargest = Scalar(1e20);

 private:
  Scalar last_ = 0;
  Scalar delta_ = 0;
};

}  // namespace tenon
