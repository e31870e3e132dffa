// The one ruler that judges every back end: how far (x, lambda, z) is from satisfying the first-order conditions
//
//     stationarity     | grad f + J' lambda + z |_inf
//     primal           max violation of c_lower <= c(x) - e <= c_upper, e = D (lambda - preload), and of x_lower <= x <= x_upper
//     complementarity  max |multiplier| * distance to the bound its sign points at; |multiplier| where that bound is absent
//
// The scaled form divides stationarity and complementarity by s = max(s_max, mean |multiplier|) / s_max with s_max = 100
// [Waechter & Biegler 2006, eq. 6]: multipliers of 1e6 cannot be computed to 1e-8 in double precision.
#pragma once

#include <algorithm>
#include <cmath>

#include "tenon/core/point.hpp"

namespace tenon {

struct KktResidual {
  double stationarity = 0;
  double primal = 0;
  double complementarity = 0;
  double scale = 1;  // s >= 1

  double max() const { return std::max({stationarity, primal, complementarity}); }
  double max_scaled() const { return std::max({stationarity / scale, primal, complementarity / scale}); }
};

namespace detail {

/// max |multiplier| * distance to the bound that its sign points at; |multiplier| where that bound is absent; 0 where the two are equal.
template <class Vec, class Multipliers>
double complementarity(const Vec& v, const Vec& lower, const Vec& upper, const Multipliers& multiplier) {
  double largest = 0;
  for (Eigen::Index i = 0; i < v.size(); ++i) {
    if (lower[i] == upper[i]) continue;
    const double bound = multiplier[i] > 0 ? upper[i] : lower[i], size = std::abs(multiplier[i]);
    largest = std::max(largest, std::isinf(bound) ? size : size * std::abs(v[i] - bound));
  }
  return largest;
}

/// max violation of lower <= v <= upper; infinite where v is not a number.
template <class Vec>
double violation(const Vec& v, const Vec& lower, const Vec& upper) {
  if (v.size() == 0) return 0;
  if (!(v.array() == v.array()).all()) return kInfinity<double>;
  return std::max(0.0, double((lower - v).cwiseMax(v - upper).maxCoeff()));
}

}  // namespace detail

/// Residual from what holds at the point: stationarity = grad f + J' lambda + z (n), rows = c(x) - D (lambda - preload) (m).
template <class Scalar, int N, int M>
KktResidual kkt_residual(const BasicPoint<Scalar, N, M>& point, const BasicBounds<Scalar, N, M>& bounds,
                         const Eigen::Matrix<Scalar, N, 1>& stationarity, const Eigen::Matrix<Scalar, M, 1>& rows) {
  KktResidual residual;
  const auto n = point.x.size(), m = point.lambda.size();
  residual.stationarity = stationarity.allFinite() ? double(stationarity.template lpNorm<Eigen::Infinity>()) : kInfinity<double>;
  residual.primal = std::max(detail::violation(point.x, bounds.x_lower, bounds.x_upper), detail::violation(rows, bounds.c_lower, bounds.c_upper));
  residual.complementarity = std::max(detail::complementarity(point.x, bounds.x_lower, bounds.x_upper, point.z),
                                      detail::complementarity(rows, bounds.c_lower, bounds.c_upper, point.lambda));
  const double multiplier_sum = double(point.z.template lpNorm<1>() + point.lambda.template lpNorm<1>());
  constexpr double kMultiplierScale = 100;  // s_max
  residual.scale = std::max(kMultiplierScale, multiplier_sum / double(std::max<Eigen::Index>(1, n + m))) / kMultiplierScale;
  return residual;
}

/// The same for any Nlp, evaluated afresh. Allocates.
KktResidual kkt_residual(const Nlp& problem, const Point& point);

}  // namespace tenon
