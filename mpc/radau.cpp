#include "tenon/mpc/radau.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

#include "tenon/core/plan.hpp"

namespace tenon {

namespace {

constexpr int kMostPoints = 8;
constexpr double kPi = 3.14159265358979323846;

/// P_s - P_{s-1} at z, and its derivative: its zeros in (-1, 1] are the abscissae, as 2 c - 1.
/// (n + 1) P_{n+1} = (2 n + 1) z P_n - n P_{n-1}
struct Legendre {
  double value, derivative;

  Legendre(int s, double z) {
    double p = 1, dp = 0, before = 0, d_before = 0;  // P_n and P_{n-1}, n = 0
    for (int n = 0; n < s; ++n) {
      const double next = ((2 * n + 1) * z * p - n * before) / (n + 1);
      const double d_next = ((2 * n + 1) * (p + z * dp) - n * d_before) / (n + 1);
      before = p, d_before = dp, p = next, dp = d_next;
    }
    value = p - before, derivative = dp - d_before;
  }
};

/// Newton's method, from the abscissae of the Chebyshev polynomials' kind; i = 1 .. s - 1.
double abscissa(int s, int i) {
  double z = -std::cos(kPi * (2 * i - 1) / (2 * s - 1));
  for (int iteration = 0; iteration < 50; ++iteration) {
    const Legendre at(s, z);
    z -= at.value / at.derivative;
  }
  return (1 + z) / 2;
}

}  // namespace

Radau radau(int points) {
  if (points < 1 || points > kMostPoints)
    throw std::invalid_argument("Radau method with " + std::to_string(points) + " points (expected 1 to 8)");
  Radau out;
  out.points = points;
  out.abscissae = Vector::Zero(points + 1);
  for (int i = 1; i < points; ++i) out.abscissae[i] = abscissa(points, i);
  out.abscissae[points] = 1;
  out.d.resize(points, points + 1);
  Vector value(points + 1), derivative(points + 1);
  for (int i = 0; i < points; ++i) {
    interpolation_weights(out.abscissae, out.abscissae[i + 1], value, derivative);
    out.d.row(i) = derivative.transpose();
  }
  // sum_i b_i c_i^k = 1/(k + 1),  k = 0 .. s - 1
  Eigen::MatrixXd powers(points, points);
  Vector moments(points);
  for (int k = 0; k < points; ++k) {
    powers.row(k) = out.abscissae.tail(points).array().pow(k).transpose();
    moments[k] = 1.0 / (k + 1);
  }
  out.weights = powers.partialPivLu().solve(moments);
  return out;
}

}  // namespace tenon
