// Columns in whole lanes: the three kernels of the dense factorisation.
//
// A column is stored 32-byte aligned and padded with zeros to a multiple of kLanes: every loop runs in full vector registers,
// without a peeled head or tail. A loop that should begin at row i begins at the lane of i: the callers keep what lies before it harmless
// (zero, or the unused upper triangle).
#pragma once

#include "tenon/core/eigen.hpp"

namespace tenon::lanes {

template <class Scalar>
inline constexpr int kLanes = static_cast<int>(32 / sizeof(Scalar));

template <class Scalar>
using Lane = Eigen::Array<Scalar, kLanes<Scalar>, 1>;

template <class Scalar>
using ConstMap = Eigen::Map<const Lane<Scalar>, Eigen::Aligned32>;

template <class Scalar>
using Map = Eigen::Map<Lane<Scalar>, Eigen::Aligned32>;

/// First row of the lane that holds row i.
template <class Scalar>
constexpr int lane_of(int i) {
  return i - i % kLanes<Scalar>;
}

/// n rounded up to whole lanes.
template <class Scalar>
constexpr int padded(int n) {
  return lane_of<Scalar>(n + kLanes<Scalar> - 1);
}

/// y -= a x, over the lanes that hold rows begin .. end-1.
template <class Scalar>
inline void subtract_scaled(Scalar a, const Scalar* x, Scalar* y, int begin, int end) {
  const Lane<Scalar> factor = Lane<Scalar>::Constant(a);
  for (int i = lane_of<Scalar>(begin); i < end; i += kLanes<Scalar>) Map<Scalar>(y + i) -= factor * ConstMap<Scalar>(x + i);
}

/// z -= a x + b y, over the lanes that hold rows begin .. end-1.
template <class Scalar>
inline void subtract_scaled(Scalar a, const Scalar* x, Scalar b, const Scalar* y, Scalar* z, int begin, int end) {
  const Lane<Scalar> factor_x = Lane<Scalar>::Constant(a);
  const Lane<Scalar> factor_y = Lane<Scalar>::Constant(b);
  for (int i = lane_of<Scalar>(begin); i < end; i += kLanes<Scalar>) {
    Map<Scalar>(z + i) -= factor_x * ConstMap<Scalar>(x + i) + factor_y * ConstMap<Scalar>(y + i);
  }
}

/// x' y over the lanes that hold rows begin .. end-1.
template <class Scalar>
inline Scalar dot(const Scalar* x, const Scalar* y, int begin, int end) {
  Lane<Scalar> sum = Lane<Scalar>::Zero();
  for (int i = lane_of<Scalar>(begin); i < end; i += kLanes<Scalar>) sum += ConstMap<Scalar>(x + i) * ConstMap<Scalar>(y + i);
  return sum.sum();
}

/// max |x_i| over rows begin .. end-1 exactly: nothing before `begin` counts; the padding after `end` holds zeros.
template <class Scalar>
inline Scalar max_abs(const Scalar* x, int begin, int end) {
  Scalar head = 0;
  int i = begin;
  for (; i < end && i % kLanes<Scalar> != 0; ++i) head = std::max(head, std::abs(x[i]));
  Lane<Scalar> largest = Lane<Scalar>::Zero();
  for (; i < end; i += kLanes<Scalar>) largest = largest.max(ConstMap<Scalar>(x + i).abs());
  return std::max(head, largest.maxCoeff());
}

}  // namespace tenon::lanes
