#include "tenon/problems/peg_in_hole/modes.hpp"

#include <cmath>

namespace tenon::peg {

namespace {

constexpr int kCornerRight = 1, kLowerEdgeLeft = 2;

struct Stance {
  const char* name;
  Vector3d pose;  // mm, the hole's mouth in the origin
  std::vector<int> contacts;
};

std::vector<Stance> stances(const Geometry& g) {
  const double wall = g.clearance / 2, deep = g.width / 2, leaning = 0.1;
  return {
      {"free", {0, 5, 0}, {}},
      {"flat", {wall + 2 * g.chamfer, 0, 0}, {kCornerRight}},
      {"chamfer", {wall + g.chamfer / 2, -g.chamfer / 2, 0}, {kCornerRight}},
      {"wall", {wall, -deep, leaning}, {kCornerRight}},
      {"wedged", {wall, -deep, leaning}, {kCornerRight, kLowerEdgeLeft}},
  };
}

}  // namespace

std::vector<LinearMode> linear_modes(const World& world, const Impedance& impedance, double period, double delay) {
  const double lever = 1e-3 * world.geometry.lever, k = 1e3 * world.contact_stiffness;  // m, N/m
  const double d = 2 * world.contact_damping_ratio * std::sqrt(k * world.mass[0]);
  const Vector3d to_si(1, 1, lever);  // of a gradient by (x, z, phi)
  const Vector3d squared = to_si.cwiseProduct(to_si);
  std::vector<LinearMode> modes;
  for (const Stance& stance : stances(world.geometry)) {
    LinearMode mode{stance.name,
                    world.mass.cwiseProduct(squared).asDiagonal(),
                    (1e3 * impedance.stiffness).cwiseProduct(squared).asDiagonal(),
                    (1e3 * impedance.damping()).cwiseProduct(squared).asDiagonal(),
                    Eigen::MatrixXd::Zero(3, 3),
                    Eigen::MatrixXd::Zero(3, 3),
                    period,
                    delay};
    for (const int contact : stance.contacts) {
      const Vector3d n = exact_gap(world.geometry, contact, stance.pose, Vector3d::Zero()).normal.cwiseProduct(to_si);
      mode.contact_stiffness += k * n * n.transpose();
      mode.contact_damping += d * n * n.transpose();
    }
    modes.push_back(std::move(mode));
  }
  return modes;
}

}  // namespace tenon::peg
