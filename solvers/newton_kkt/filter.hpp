// The filter: pairs (theta, phi) of constraint violation and barrier objective that a new iterate may not fall behind.
//
// A point is acceptable if against every entry it is better by a margin in one of the two.  [WB06, eq. 18 and sec. 2.3]
// The capacity is fixed, so that nothing allocates; where it is full the oldest entry is forgotten.
#pragma once

#include <array>
#include <cmath>

namespace tenon {

template <class Scalar>
class Filter {
 public:
  void clear() { size_ = 0; }

  bool accepts(Scalar theta, Scalar phi) const {
    for (int k = 0; k < size_; ++k) {
      if (theta >= entries_[k].theta && phi >= entries_[k].phi) return false;
    }
    return true;
  }

  // [WB06] has gamma_phi = 1e-8, with which phi may pay for a violation that grows and grows where f is flat (hs057)
  static constexpr Scalar kGammaTheta = Scalar(1e-5), kGammaPhi = Scalar(1e-6);

  /// Forbids what is not better than this point by the margins gamma_theta, gamma_phi of its violation.
  void add(Scalar theta, Scalar phi) {
    const Entry entry{(1 - kGammaTheta) * theta, phi - kGammaPhi * theta};
    int kept = 0;
    for (int k = 0; k < size_; ++k) {
      const bool dominated = entries_[k].theta >= entry.theta && entries_[k].phi >= entry.phi;
      if (!dominated) entries_[kept++] = entries_[k];
    }
    if (kept == kCapacity) {
      for (int k = 1; k < kCapacity; ++k) entries_[k - 1] = entries_[k];
      --kept;
    }
    entries_[kept++] = entry;
    size_ = kept;
  }

  int size() const { return size_; }

 private:
  static constexpr int kCapacity = 64;
  struct Entry {
    Scalar theta, phi;
  };
  std::array<Entry, kCapacity> entries_;
  int size_ = 0;
};

}  // namespace tenon
