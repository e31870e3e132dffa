// Directions: a grid over the whole sphere, and the search for an extreme from a point of it.
#pragma once

#include <functional>
#include <vector>

#include "tenon/core/eigen.hpp"

namespace tenon {

inline constexpr int kLeastDirections = 6;

/// `count` >= 6 unit vectors: the six half-axes x, -x, y, -y, z, -z, then a Fibonacci lattice,
///     z_k = 1 - (2k + 1)/n,   longitude k (3 - sqrt 5) pi.
std::vector<Eigen::Vector3d> sphere_grid(int count);

struct SphereExtreme {
  double value;
  Eigen::Vector3d direction;
};

/// The largest value near a direction: six neighbours at a distance are tried, which is halved where none is better, from `reach` (rad) to
/// 1e-6. A value that is NaN counts as the lowest; `value` at the start is known.
SphereExtreme climb(const std::function<double(const Eigen::Vector3d&)>& quantity, SphereExtreme start, double reach);

}  // namespace tenon
