#include "tenon/solvers/local_infeasibility.hpp"

#include <algorithm>
#include <cmath>

namespace tenon {

Vector signed_violation(const Vector& constraints, const Bounds& bounds) {
  return (constraints - bounds.c_upper).cwiseMax(0) + (constraints - bounds.c_lower).cwiseMin(0);
}

bool is_locally_infeasible(const Vector& x, const Bounds& bounds, const FirstOrder& here) {
  constexpr double kInfeasible = 1e-6;  // a violation above this is one
  constexpr double kCancelled = 1e-3;   // what J'v may keep of its terms where they cancel
  constexpr double kVanished = 1e-6;    // what it may be of v where J itself vanishes
  const Vector v = signed_violation(here.constraints, bounds);
  if (v.size() == 0 || !(v.lpNorm<Eigen::Infinity>() > kInfeasible)) return false;

  const Vector descent = -here.jacobian.transpose() * v;
  const Vector scale = here.jacobian.cwiseAbs().transpose() * v.cwiseAbs();
  const double vanished = kVanished * v.lpNorm<Eigen::Infinity>();
  for (int j = 0; j < x.size(); ++j) {
    const bool blocked = descent[j] > 0 ? x[j] >= bounds.x_upper[j] : x[j] <= bounds.x_lower[j];
    if (!blocked && std::abs(descent[j]) > std::max(vanished, kCancelled * scale[j])) return false;
  }
  return true;
}

}  // namespace tenon
