// Sine and cosine of a few angles at once, in whole vector registers and without a branch.
//
//     a = k pi/2 + r,  |r| <= pi/4     (Cody & Waite: pi/2 in three parts, exact for |k| < 2^20, some 260,000 turns)
//     sin r, cos r by their Taylor series: the first term left out is below 1e-19 on |r| <= pi/4
#pragma once

#include "tenon/core/eigen.hpp"

namespace tenon {

template <class Scalar, int N>
inline void sine_and_cosine(const Eigen::Array<Scalar, N, 1>& angle, Eigen::Array<Scalar, N, 1>& sine, Eigen::Array<Scalar, N, 1>& cosine) {
  constexpr double kTwoOverPi = 0.63661977236758134308;
  constexpr double kPart1 = 0x1.921fb544p+0, kPart2 = 0x1.0b4611a6p-34, kPart3 = 0x1.3198a2e037073p-69;  // pi/2, 33 bits each
  constexpr double kRound = 0x1.8p52;  // adding and subtracting it rounds to the nearest integer
  using Lanes = Eigen::Array<double, (N + 3) / 4 * 4, 1>;
  Lanes a = Lanes::Zero();
  for (int i = 0; i < N; ++i) a[i] = double(angle[i]);

  const Lanes k = (a * kTwoOverPi + kRound) - kRound;
  const Lanes r = ((a - k * kPart1) - k * kPart2) - k * kPart3;
  const Lanes q = r * r;
  // sin r = r - r^3/3! + ... + r^17/17!,   cos r = 1 - r^2/2! + ... + r^16/16!; two chains each, so that they overlap
  const Lanes q2 = q * q;
  const Lanes odd_even = -1.0 / 6 + q2 * (-1.0 / 5040 + q2 * (-1.0 / 39916800 + q2 * (-1.0 / 1307674368000)));
  const Lanes odd_odd = 1.0 / 120 + q2 * (1.0 / 362880 + q2 * (1.0 / 6227020800 + q2 * (1.0 / 355687428096000)));
  const Lanes sin_r = r + r * (q * (odd_even + q * odd_odd));
  const Lanes even_even = -0.5 + q2 * (-1.0 / 720 + q2 * (-1.0 / 3628800 + q2 * (-1.0 / 87178291200)));
  const Lanes even_odd = 1.0 / 24 + q2 * (1.0 / 40320 + q2 * (1.0 / 479001600 + q2 * (1.0 / 20922789888000)));
  const Lanes cos_r = 1.0 + q * (even_even + q * even_odd);

  // quadrant k mod 4: odd ones swap sine and cosine; 2 and 3 turn the sine's sign, 1 and 2 the cosine's. Products with 0 and 1 are exact.
  const Lanes half = (k * 0.5).floor();
  const Lanes swap = k - 2 * half;                        // 0 or 1
  const Lanes sign = 1 - 2 * (half - 2 * (half * 0.5).floor());  // 1 or -1
  const Lanes s = sign * ((1 - swap) * sin_r + swap * cos_r);
  const Lanes c = sign * (1 - 2 * swap) * ((1 - swap) * cos_r + swap * sin_r);
  for (int i = 0; i < N; ++i) sine[i] = Scalar(s[i]), cosine[i] = Scalar(c[i]);
}

}  // namespace tenon
