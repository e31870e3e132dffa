#include "tenon/core/dependent_rows.hpp"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseQR>
#include <algorithm>
#include <cmath>

#include "tenon/core/first_order.hpp"

namespace tenon {

namespace {

constexpr double kActive = 1e-6;     // relative distance at which a bound counts as reached
constexpr double kDependent = 1e-8;  // what is left of a gradient of length 1 after the others are projected out

bool is_at(double value, double bound) {
  return std::isfinite(bound) && std::abs(value - bound) <= kActive * std::max(1.0, std::abs(bound));
}

bool is_active(double value, double lower, double upper) {
  return value <= lower || value >= upper || is_at(value, lower) || is_at(value, upper);
}

}  // namespace

std::vector<DependentRow> dependent_rows(const Nlp& problem, const Vector& x) {
  const FirstOrder here(problem, x);
  if (!x.allFinite() || !here.all_finite()) return {};
  Bounds bounds(problem.num_variables(), problem.num_constraints());
  problem.bounds(bounds);

  std::vector<DependentRow> found;
  std::vector<int> active;  // rows with a gradient
  std::vector<Eigen::Triplet<double>> entries;
  const Eigen::SparseMatrix<double, Eigen::RowMajor> rows = here.jacobian;
  for (int j = 0; j < rows.rows(); ++j) {
    if (bounds.compliance[j] > 0 || !is_active(here.constraints[j], bounds.c_lower[j], bounds.c_upper[j])) continue;
    const double length = rows.row(j).norm();
    const std::size_t before = entries.size();
    for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator entry(rows, j); entry; ++entry) {
      const int i = static_cast<int>(entry.col());
      if (!is_active(x[i], bounds.x_lower[i], bounds.x_upper[i]) && std::abs(entry.value()) > kDependent * length)
        entries.emplace_back(i, static_cast<int>(active.size()), entry.value() / length);
    }
    if (entries.size() > before)
      active.push_back(j);
    else
      found.push_back({j, {}});
  }
  if (active.empty()) return found;

  SparseMatrix gradients(rows.cols(), std::ssize(active));
  gradients.setFromTriplets(entries.begin(), entries.end());
  Eigen::SparseQR<SparseMatrix, Eigen::COLAMDOrdering<int>> qr;
  qr.setPivotThreshold(kDependent);
  qr.compute(gradients);
  const Eigen::Index rank = qr.rank();
  const auto row_at = [&](Eigen::Index k) { return active[std::size_t(qr.colsPermutation().indices()[k])]; };
  const SparseMatrix r = qr.matrixR();
  const SparseMatrix r11 = r.topLeftCorner(rank, rank);
  for (Eigen::Index k = rank; k < std::ssize(active); ++k) {
    Vector weights = r.col(k).head(rank);
    r11.triangularView<Eigen::Upper>().solveInPlace(weights);
    DependentRow dependent{row_at(k), {}};
    for (Eigen::Index i = 0; i < rank; ++i) {
      if (std::abs(weights[i]) > kActive) dependent.on.push_back(row_at(i));
    }
    std::ranges::sort(dependent.on);
    found.push_back(dependent);
  }
  std::ranges::sort(found, {}, &DependentRow::row);
  return found;
}

}  // namespace tenon
