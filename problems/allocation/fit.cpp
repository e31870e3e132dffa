#include "tenon/problems/allocation/fit.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "tenon/problems/allocation/throttle_map.hpp"

// clang-format off: Eigen's own headers come after the one that pins its alignment
#include "tenon/core/eigen.hpp"
#include <Eigen/QR>
// clang-format on

namespace tenon {

PolynomialFit fit_polynomial(const std::vector<double>& u, const std::vector<double>& y, int degree, bool constant) {
  constexpr int kMaxDegree = 6;
  if (degree < 1 || degree > kMaxDegree) {
    throw std::invalid_argument("the degree of a fit is " + std::to_string(degree) + " (expected 1 to " + std::to_string(kMaxDegree) + ")");
  }
  const int first = constant ? 0 : 1;
  const int unknowns = degree + 1 - first;
  const auto samples = static_cast<Eigen::Index>(u.size());
  std::set<double> distinct(u.begin(), u.end());
  if (!constant) distinct.erase(0.0);  // says nothing about a map without a constant
  if (static_cast<int>(distinct.size()) < unknowns) {
    throw std::invalid_argument("a fit of " + std::to_string(unknowns) + " coefficients has " + std::to_string(distinct.size()) +
                                " distinct throttles above 0 (expected at least as many)");
  }

  Eigen::MatrixXd powers(samples, unknowns);
  for (Eigen::Index k = 0; k < samples; ++k) {
    for (int j = 0; j < unknowns; ++j) powers(k, j) = std::pow(u[static_cast<std::size_t>(k)], j + first);
  }
  const Vector values = Eigen::Map<const Vector>(y.data(), samples);
  const Vector solution = powers.colPivHouseholderQr().solve(values);
  const Vector residual = powers * solution - values;

  PolynomialFit fit;
  fit.coefficients.assign(static_cast<std::size_t>(first), 0.0);
  fit.coefficients.insert(fit.coefficients.end(), solution.begin(), solution.end());
  fit.max_residual = residual.cwiseAbs().maxCoeff();
  fit.rms_residual = std::sqrt(residual.squaredNorm() / static_cast<double>(samples));
  fit.rises = rises(fit.coefficients, 0, 1);
  return fit;
}

BenchFit fit_bench(const std::string& file, int degree, bool constant) {
  const CsvTable table = read_csv(file, {{"u", "thrust", "torque"}, {}});
  const std::vector<double>& u = table["u"];
  for (int k = 0; k < table.rows(); ++k) {
    const double value = u[static_cast<std::size_t>(k)];
    if (value < 0 || value > 1) {
      throw InputError({file, table.lines[static_cast<std::size_t>(k)], 1}, "the throttle u is " + std::to_string(value), "0 to 1");
    }
  }
  try {
    return {fit_polynomial(u, table["thrust"], degree, constant), fit_polynomial(u, table["torque"], degree, constant), table.rows()};
  } catch (const std::invalid_argument& error) {
    throw InputError({file, 0, 0}, error.what());
  }
}

}  // namespace tenon
