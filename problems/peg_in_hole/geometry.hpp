// A planar peg above a chamfered hole: the gaps of six contacts, smooth for a planner and exact for a plant.
//
//     h = smax of the faces of a convex pair,   smax(a, b) = (a + b + sqrt((a - b)^2 + delta^2)) / 2              peg_in_hole.md (1.1), (1.2)
//
// Each gap is positive wherever its corner is outside the solid it may touch, so that nobody has to know which face is meant. Lengths are
// millimetres, z points up; a pose is (x, z, phi) of the peg's bottom centre, phi = lever * theta, so that all three have one unit.
#pragma once

#include <array>

#include "tenon/core/eigen.hpp"

namespace tenon::peg {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

struct Geometry {
  double width = 20;      // mm, of the peg
  double clearance = 0.2;  // mm, both sides together
  double chamfer = 1;     // mm, at 45 degrees
  double lever = 20;      // mm of phi for each radian of theta

  double half_opening() const { return (width + clearance) / 2; }
};

/// Who touches whom: a lower corner of the peg one of the two blocks that make the hole, or a vertex of a block the peg.
inline constexpr int kContacts = 6;
inline constexpr std::array<const char*, kContacts> kContactNames{"corner_left",      "corner_right",    "lower_edge_left",
                                                                  "lower_edge_right", "upper_edge_left", "upper_edge_right"};
/// -1: the contact is on the left (x < 0), +1: on the right.
constexpr double side_of(int contact) {
  return contact % 2 == 0 ? -1 : 1;
}

/// A function of a pose, and what is left of its third derivative along a direction y.
struct Jet {
  double value;       // mm
  Vector3d gradient;  // 1
  Matrix3d hessian;   // 1/mm
  Matrix3d along;     // hess(gradient . y)
};

/// The smooth gaps and their first two derivatives by the peg's pose, the third one along y; `hole` is the pose of the hole's mouth (top, middle).
std::array<Jet, kContacts> smooth_gaps(const Geometry& geometry, double smoothing, const Vector3d& pose, const Vector3d& hole,
                                       const Vector3d& y = Vector3d::Zero());

/// The unsmoothed gap, and how a unit push and a unit friction there act on the pose.
struct ExactGap {
  double value;      // mm
  Vector3d normal;   // gradient of the gap
  Vector3d tangent;  // the same for the direction that is a right angle to the left of the normal
};
std::array<ExactGap, kContacts> exact_gaps(const Geometry& geometry, const Vector3d& pose, const Vector3d& hole);

/// mm: how far the middle of the peg's bottom is below the mouth, along the hole.
double depth(const Geometry& geometry, const Vector3d& pose, const Vector3d& hole);

}  // namespace tenon::peg
