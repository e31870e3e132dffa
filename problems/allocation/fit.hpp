// Thrust and torque maps from bench data: polynomials in the throttle by least squares.
//
//     minimise over p:  sum_k ( sum_j p_j u_k^j - y_k )^2,    j = first .. degree,  first = 1 (no thrust at rest) or 0
#pragma once

#include <string>
#include <vector>

#include "tenon/core/csv.hpp"

namespace tenon {

struct PolynomialFit {
  std::vector<double> coefficients;  // ascending, degree + 1 of them; the first is 0 where no constant was asked for
  double max_residual = 0;           // largest |p(u_k) - y_k|
  double rms_residual = 0;
  bool rises = true;  // on the throttle's range [0, 1]; false is a map that an allocation cannot invert
};

struct BenchFit {
  PolynomialFit thrust;  // N
  PolynomialFit torque;  // N m
  int samples = 0;
};

/// Degree 1 to 6. Throws std::invalid_argument for another degree, or where u takes fewer distinct values than there are coefficients.
PolynomialFit fit_polynomial(const std::vector<double>& u, const std::vector<double>& y, int degree, bool constant);

/// Columns u (in [0, 1]), thrust (N) and torque (N m) of a bench record. Throws InputError.
BenchFit fit_bench(const std::string& file, int degree = 2, bool constant = false);

}  // namespace tenon
