// Which feature of a convex shape a point is nearest to: the gap that holds there.
//
//     face, or inside a polygon or box: the face whose distance is largest;  outside: the nearest face, edge or corner
#pragma once

#include <limits>

#include "tenon/problems/contact/scene.hpp"

namespace tenon::contact {

/// Outward normal of the edge from a to b of a polygon that runs counter-clockwise.
inline Point<double, 2> outward_normal(const Point<double, 2>& a, const Point<double, 2>& b) {
  const Point<double, 2> along = (b - a).normalized();
  return {along[1], -along[0]};
}

/// A point within this share of an edge's length beyond its end is still over the edge: corners that stand on corners.
inline constexpr double kCorner = 1e-6;

/// The gap between the point `a` of body A and the feature of the shape that is nearest to `p`, the same point in body B's axes.
inline Gap<2> nearest_feature(const Constraint<2>& c, const Point<double, 2>& p) {
  Gap<2> gap = c.gap;
  gap.offset = c.radius;
  const auto& vertices = c.shape.vertices;
  const auto face = [&](const Point<double, 2>& b, const Point<double, 2>& n) {
    gap.kind = GapKind::point_face;
    gap.b = b, gap.n = n;
    return gap;
  };
  if (c.shape.is_face()) return face(vertices[0], c.shape.normal);

  const std::size_t n = vertices.size(), edges = n == 2 ? 1 : n;
  double nearest = std::numeric_limits<double>::infinity(), highest = -nearest;
  std::size_t near_edge = 0, high_edge = 0;
  double along = 0;
  for (std::size_t k = 0; k < edges; ++k) {
    const Point<double, 2>&v = vertices[k], &w = vertices[(k + 1) % n];
    const double height = outward_normal(v, w).dot(p - v);
    if (height > highest) highest = height, high_edge = k;
    const double s = (p - v).dot(w - v) / (w - v).squaredNorm();
    const double distance = (p - v - std::clamp(s, 0.0, 1.0) * (w - v)).norm();
    if (distance < nearest) nearest = distance, near_edge = k, along = s;
  }
  if (n > 2 && highest <= 0) return face(vertices[high_edge], outward_normal(vertices[high_edge], vertices[(high_edge + 1) % n]));
  const Point<double, 2>&v = vertices[near_edge], &w = vertices[(near_edge + 1) % n];
  if (along > -kCorner && along < 1 + kCorner) {
    const Point<double, 2> normal = outward_normal(v, w);
    return face(v, n == 2 && normal.dot(p - v) < 0 ? Point<double, 2>(-normal) : normal);
  }
  gap.kind = GapKind::point_point;
  gap.b = along < 0.5 ? v : w;
  return gap;
}

inline Gap<3> nearest_feature(const Constraint<3>& c, const Point<double, 3>& p) {
  Gap<3> gap = c.gap;
  gap.offset = c.radius;
  const auto& vertices = c.shape.vertices;
  if (c.shape.is_face()) {
    gap.kind = GapKind::point_face;
    gap.b = vertices[0], gap.n = c.shape.normal;
    return gap;
  }
  if (c.shape.is_box()) {
    const Point<double, 3> d = p - vertices[0], over = d.cwiseAbs() - c.shape.half;
    int outside = 0, last = 0, highest = 0;
    Point<double, 3> corner = vertices[0];
    for (int i = 0; i < 3; ++i) {
      if (over[i] > over[highest]) highest = i;
      if (over[i] > 0) ++outside, corner[i] += std::copysign(c.shape.half[i], d[i]);
      if (over[i] <= 0) last = i;
    }
    gap.b = corner;
    if (outside == 3) {
      gap.kind = GapKind::point_point;
    } else if (outside == 2) {
      gap.kind = GapKind::point_edge;
      gap.n = Point<double, 3>::Unit(last);
    } else {
      gap.kind = GapKind::point_face;
      gap.n = std::copysign(1.0, d[highest]) * Point<double, 3>::Unit(highest);
      gap.b = vertices[0] + gap.n * c.shape.half[highest];
    }
    return gap;
  }
  const Point<double, 3> along = vertices[1] - vertices[0];
  const double s = (p - vertices[0]).dot(along) / along.squaredNorm();
  gap.kind = s > 0 && s < 1 ? GapKind::point_edge : GapKind::point_point;
  gap.b = s <= 0 ? vertices[0] : s >= 1 ? vertices[1] : vertices[0];
  gap.n = along.normalized();
  return gap;
}

/// How far a contact may close beyond its touch before it looks like another, m: its balls, half of the polygon's or box's least side, a
/// tenth of a rope. Infinity where there is nothing behind a face.
template <int D>
double reach(const Constraint<D>& c) {
  if (c.shape.is_face()) return std::numeric_limits<double>::infinity();
  if (c.shape.is_box()) return c.radius + c.shape.half.minCoeff();
  if (c.shape.vertices.empty()) return c.gap.sign < 0 ? 0.1 * c.gap.offset : c.radius;
  const auto& vertices = c.shape.vertices;
  double least = vertices.size() == 2 ? 0 : std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < vertices.size(); ++k)
    least = std::min(least, 0.5 * (vertices[(k + 1) % vertices.size()] - vertices[k]).norm());
  return c.radius + least;
}

/// The smooth gap that holds at these poses.
template <int D>
Gap<D> gap_at(const Constraint<D>& c, const Pose<double, D>& A, const Pose<double, D>& B) {
  if (c.shape.vertices.empty()) return c.gap;
  const Point<double, D> x = A.p + A.R * c.gap.a;
  const Point<double, D> p = B.R.transpose() * (x - B.p);
  return nearest_feature(c, p);
}

}  // namespace tenon::contact
