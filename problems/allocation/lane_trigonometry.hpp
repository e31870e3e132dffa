// Sine and cosine of a few angles at once, without a branch, so that the compiler turns the loop into vector instructions.
//
//     a = k pi/2 + r,  |r| <= pi/4     (Cody & Waite: pi/2 in three parts, exact for |k| < 2^20, some 260,000 turns)
//     sin r, cos r by their Taylor series: the first term left out is below 1e-19 on |r| <= pi/4
#pragma once

#include <cmath>

#include "tenon/core/eigen.hpp"

namespace tenon {

template <class Scalar, int N>
inline void sine_and_cosine(const Eigen::Array<Scalar, N, 1>& angle, Eigen::Array<Scalar, N, 1>& sine, Eigen::Array<Scalar, N, 1>& cosine) {
  constexpr double kTwoOverPi = 0.63661977236758134308;
  constexpr double kPart1 = 0x1.921fb544p+0, kPart2 = 0x1.0b4611a6p-34, kPart3 = 0x1.3198a2e037073p-69;  // pi/2, 33 bits each
  constexpr double kRound = 0x1.8p52;  // adding and subtracting it rounds to the nearest integer
  constexpr int kLanes = (N + 3) / 4 * 4;
  alignas(32) double a[kLanes] = {}, s[kLanes], c[kLanes];
  for (int i = 0; i < N; ++i) a[i] = double(angle[i]);

  for (int i = 0; i < kLanes; ++i) {
    const double k = (a[i] * kTwoOverPi + kRound) - kRound;
    const double r = ((a[i] - k * kPart1) - k * kPart2) - k * kPart3;
    const double q = r * r;
    double odd = 1.0 / 355687428096000.0;  // 1/17!
    odd = odd * q - 1.0 / 1307674368000.0;
    odd = odd * q + 1.0 / 6227020800.0;
    odd = odd * q - 1.0 / 39916800.0;
    odd = odd * q + 1.0 / 362880.0;
    odd = odd * q - 1.0 / 5040.0;
    odd = odd * q + 1.0 / 120.0;
    odd = odd * q - 1.0 / 6.0;
    const double sin_r = r + r * (q * odd);
    double even = 1.0 / 20922789888000.0;  // 1/16!
    even = even * q - 1.0 / 87178291200.0;
    even = even * q + 1.0 / 479001600.0;
    even = even * q - 1.0 / 3628800.0;
    even = even * q + 1.0 / 40320.0;
    even = even * q - 1.0 / 720.0;
    even = even * q + 1.0 / 24.0;
    even = even * q - 0.5;
    const double cos_r = 1.0 + q * even;
    // quadrant k mod 4: odd ones swap sine and cosine, 1 and 2 change the cosine's sign, 2 and 3 the sine's
    const double half = k * 0.5, half_floor = std::floor(half);
    const bool swap = half != half_floor;
    const double sign_s = half_floor * 0.5 != std::floor(half_floor * 0.5) ? -1.0 : 1.0;
    const double sign_c = swap ? -sign_s : sign_s;
    s[i] = sign_s * (swap ? cos_r : sin_r);
    c[i] = sign_c * (swap ? sin_r : cos_r);
  }
  for (int i = 0; i < N; ++i) sine[i] = Scalar(s[i]), cosine[i] = Scalar(c[i]);
}

}  // namespace tenon
