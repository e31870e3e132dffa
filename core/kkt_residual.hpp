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

/// Distance of v to the bound that the sign of the multiplier points at, times the multiplier.
template <class Scalar>
Scalar complementarity(Scalar v, Scalar lower, Scalar upper, Scalar multiplier) {
  if (lower == upper || multiplier == 0) return 0;
  const Scalar bound = multiplier > 0 ? upper : lower;
  return std::isinf(bound) ? std::abs(multiplier) : std::abs(multiplier * (v - bound));
}

template <class Scalar>
Scalar violation(Scalar v, Scalar lower, Scalar upper) {
  return std::isnan(v) ? kInfinity<Scalar> : std::max({lower - v, v - upper, Scalar(0)});
}

}  // namespace detail

/// Residual from evaluations at point.x: gradient (n), constraints (m), Jacobian (m x n, dense or sparse).
template <class Scalar, int N, int M, class JacobianType>
KktResidual kkt_residual(const BasicPoint<Scalar, N, M>& point, const BasicBounds<Scalar, N, M>& bounds,
                         const Eigen::Matrix<Scalar, N, 1>& gradient, const Eigen::Matrix<Scalar, M, 1>& constraints,
                         const JacobianType& jacobian) {
  KktResidual residual;
  Scalar multiplier_sum = 0;
  const auto n = point.x.size(), m = point.lambda.size();

  for (Eigen::Index j = 0; j < n; ++j) {
    const Scalar rows = m == 0 ? Scalar(0) : Scalar(jacobian.col(j).dot(point.lambda));  // Eigen's sparse dot asserts a length above 0
    const Scalar stationarity = gradient[j] + rows + point.z[j];
    residual.stationarity = std::max<double>(residual.stationarity, std::isnan(stationarity) ? kInfinity<Scalar> : std::abs(stationarity));
    residual.primal = std::max<double>(residual.primal, detail::violation(point.x[j], bounds.x_lower[j], bounds.x_upper[j]));
    residual.complementarity = std::max<double>(
        residual.complementarity, detail::complementarity(point.x[j], bounds.x_lower[j], bounds.x_upper[j], point.z[j]));
    multiplier_sum += std::abs(point.z[j]);
  }
  for (Eigen::Index i = 0; i < m; ++i) {
    const Scalar row = constraints[i] - bounds.compliance[i] * (point.lambda[i] - bounds.preload[i]);
    residual.primal = std::max<double>(residual.primal, detail::violation(row, bounds.c_lower[i], bounds.c_upper[i]));
    residual.complementarity = std::max<double>(
        residual.complementarity, detail::complementarity(row, bounds.c_lower[i], bounds.c_upper[i], point.lambda[i]));
    multiplier_sum += std::abs(point.lambda[i]);
  }
  constexpr double kMultiplierScale = 100;  // s_max
  residual.scale = std::max(kMultiplierScale, double(multiplier_sum) / double(std::max<Eigen::Index>(1, n + m))) / kMultiplierScale;
  return residual;
}

/// The same for any Nlp, evaluated afresh. Allocates.
KktResidual kkt_residual(const Nlp& problem, const Point& point);

}  // namespace tenon
