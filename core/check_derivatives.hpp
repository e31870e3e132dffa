// Derivatives against differences: the one law that every problem must pass.
//
// Central differences with step h = cbrt(eps) max(1, |x_j|): error O(h^2), about 1e-10 of the scale of the function. Reported errors are
// relative to max(1, |derivative|, |value differenced|), so that a large function does not hide behind its own rounding.
#pragma once

#include <string>
#include <vector>

#include "tenon/core/nlp.hpp"

namespace tenon {

struct DerivativeError {
  std::string what;       // "gradient", "jacobian" or "hessian"
  std::string row;        // name of the row (or variable) differentiated; empty for the gradient
  std::string variable;   // name of the variable differentiated by
  double analytic = 0;    // 0 where the pattern has no such entry
  double difference = 0;
  double error = 0;       // relative, see above
};

struct DerivativeReport {
  double gradient_error = 0;  // largest relative errors
  double jacobian_error = 0;
  double hessian_error = 0;
  bool finite = true;                      // false: some function or derivative is not finite at x
  std::vector<DerivativeError> worst;      // entries above the tolerance, worst first, at most 20

  bool passed(double tolerance) const {
    return finite && gradient_error <= tolerance && jacobian_error <= tolerance && hessian_error <= tolerance;
  }
};

/// Compares gradient, Jacobian and Hessian of the Lagrangian (with these sigma, lambda) at x with central differences, entries outside the
/// patterns included. Throws std::invalid_argument where x or lambda has the wrong length.
DerivativeReport check_derivatives(const Nlp& problem, const Vector& x, double sigma, const Vector& lambda, double tolerance = 1e-6);

}  // namespace tenon
