#include "tenon/problems/envelope/sphere.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace tenon {

std::vector<Eigen::Vector3d> sphere_grid(int count) {
  std::vector<Eigen::Vector3d> out;
  for (int axis = 0; axis < 3; ++axis) {
    out.emplace_back(Eigen::Vector3d::Unit(axis));
    out.emplace_back(-Eigen::Vector3d::Unit(axis));
  }
  const int n = count - kLeastDirections;
  for (int k = 0; k < n; ++k) {
    const double z = 1 - (2.0 * k + 1) / n, radius = std::sqrt(1 - z * z), longitude = k * (3 - std::sqrt(5.0)) * std::numbers::pi;
    out.emplace_back(radius * std::cos(longitude), radius * std::sin(longitude), z);
  }
  return out;
}

SphereExtreme climb(const std::function<double(const Eigen::Vector3d&)>& quantity, SphereExtreme start, double reach) {
  constexpr int kNeighbours = 6;
  constexpr int kMaxRounds = 200;
  constexpr double kLeastReach = 1e-6;
  constexpr double kTurn = 0.7;          // rad, from one round to the next: so that no ridge hides between the neighbours
  constexpr double kImprovement = 1e-9;  // relative: less is rounding
  SphereExtreme best = start;
  for (int round = 0; reach > kLeastReach && round < kMaxRounds; ++round) {
    const Eigen::Vector3d a = best.direction.unitOrthogonal(), b = best.direction.cross(a);
    SphereExtreme ahead = best;
    for (int k = 0; k < kNeighbours; ++k) {
      const double angle = 2 * std::numbers::pi * k / kNeighbours + kTurn * round;
      const Eigen::Vector3d direction = (best.direction + reach * (std::cos(angle) * a + std::sin(angle) * b)).normalized();
      if (const double value = quantity(direction); value > ahead.value) ahead = {value, direction};
    }
    if (!(ahead.value > best.value + kImprovement * std::abs(best.value))) reach /= 2;
    best = ahead;
  }
  return best;
}

}  // namespace tenon
