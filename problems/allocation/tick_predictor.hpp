// Where to start the next tick: from a given guess, or from the last ticks extrapolated, whichever would have been nearer the last time.
//
//     order 1:  2 p_k - p_{k-1}             order 2:  3 p_k - 3 p_{k-1} + p_{k-2}
//
// A smooth log is then met almost exactly, while noise, which extrapolation would amplify, falls back to the guess by itself.
#pragma once

#include "tenon/core/eigen.hpp"

namespace tenon {

template <class Vec>
class TickPredictor {
 public:
  void reset() { known_ = 0, best_ = 0; }

  /// The start of this tick; `guess` is the candidate that needs no history.
  const Vec& predict(const Vec& guess) {
    candidate_[0] = guess;
    if (known_ >= 2) candidate_[1] = 2 * last_[0] - last_[1];
    if (known_ >= 3) candidate_[2] = 3 * (last_[0] - last_[1]) + last_[2];
    return candidate_[best_];
  }

  /// The tick's solution: the candidate nearest to it leads the next tick.
  void learn(const Vec& solution) {
    auto least = (candidate_[0] - solution).squaredNorm();
    best_ = 0;
    for (int order = 1; order < known_; ++order) {
      const auto error = (candidate_[order] - solution).squaredNorm();
      if (error < least) least = error, best_ = order;
    }
    last_[2] = last_[1], last_[1] = last_[0], last_[0] = solution;
    known_ = known_ < 3 ? known_ + 1 : 3;
  }

 private:
  Vec candidate_[3], last_[3];  // last_[0] is the newest
  int known_ = 0;               // how many of last_ are
  int best_ = 0;
};

}  // namespace tenon
