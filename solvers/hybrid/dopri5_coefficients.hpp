// The coefficients of DOPRI5, an explicit Runge-Kutta method of order 5 with an error estimate of order 4 and a continuous extension of
// order 4. Rows of A stand one after another, the row of stage i with i entries; stage 6 is the solution itself (B).
//
// Source: J. R. Dormand, P. J. Prince, A family of embedded Runge-Kutta formulae, J. Comput. Appl. Math. 6 (1980); E. Hairer,
// S. P. Norsett, G. Wanner, Solving Ordinary Differential Equations I, 2nd ed. (1993), table II.5.2 and sec. II.6.
#pragma once

#include <array>
#include <cmath>

#include "tenon/core/eigen.hpp"

namespace tenon {

struct Dopri5 {
  static constexpr int kErrorOrder = 5;      // a step's error grows as its length to this power
  static constexpr int kStages = 6;          // of a step
  static constexpr int kExtendedStages = 7;  // with the derivative at the end
  static constexpr int kPowers = 4;          // of the continuous extension

  static constexpr std::array<double, kExtendedStages> kC = {0, 1.0 / 5, 3.0 / 10, 4.0 / 5, 8.0 / 9, 1, 1};

  static constexpr std::array<double, 21> kA = {
      1.0 / 5,
      3.0 / 40,
      9.0 / 40,
      44.0 / 45,
      -56.0 / 15,
      32.0 / 9,
      19372.0 / 6561,
      -25360.0 / 2187,
      64448.0 / 6561,
      -212.0 / 729,
      9017.0 / 3168,
      -355.0 / 33,
      46732.0 / 5247,
      49.0 / 176,
      -5103.0 / 18656,
      35.0 / 384,
      0,
      500.0 / 1113,
      125.0 / 192,
      -2187.0 / 6784,
      11.0 / 84,
  };

  /// The solution's weights less those of a method of order 4.
  static constexpr std::array<double, kExtendedStages> kE = {
      71.0 / 57600, 0, -71.0 / 16695, 71.0 / 1920, -17253.0 / 339200, 22.0 / 525, -1.0 / 40,
  };

  /// The upper power of the continuous extension.
  static constexpr std::array<std::array<double, kExtendedStages>, 1> kD = {{
      {-12715105075.0 / 11282082432, 0, 87487479700.0 / 32700410799, -10690763975.0 / 1880347072, 701980252875.0 / 199316789632,
       -1453857185.0 / 822651844, 69997945.0 / 29380423},
  }};

  /// Of a step of length h, in the norm of `scale`; at most 1 where the step is accurate enough.
  template <class Stages>
  static double error_norm(double h, const Stages& stages, const Vector& scale, Vector& sum) {
    sum = stages * Eigen::Map<const Vector>(kE.data(), kExtendedStages);
    return h * std::sqrt(sum.cwiseQuotient(scale).squaredNorm() / static_cast<double>(scale.size()));
  }
};

}  // namespace tenon
