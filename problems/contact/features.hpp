// Which feature of a convex shape a point is nearest to: the gap that holds there.
//
//     face, or inside a polygon or box: the face whose distance is largest;  outside: the nearest face, edge or corner
//
// Where a point slides from a face onto a corner the gap's curvature jumps, and h'' with it: a contact holds its feature until an event.
#pragma once

#include <limits>

#include "tenon/problems/contact/scene.hpp"

namespace tenon::contact {

/// Outward normal of the edge from a to b of a polygon that runs counter-clockwise.
inline Point<double, 2> outward_normal(const Point<double, 2>& a, const Point<double, 2>& b) {
  const Point<double, 2> along = (b - a).normalized();
  return {along[1], -along[0]};
}

/// A point without a radius is still over an edge up to this share of its length beyond its end: corners that stand on corners.
inline constexpr double kCorner = 1e-6;
inline double corner_slack(const Constraint<2>& c) {
  return c.radius > 0 ? 0 : kCorner;
}

/// Of a polygon with n vertices, face k < n runs from vertex k to the next, and n + k is the corner at vertex k.
inline constexpr int kNearest = -1;

/// The feature that is nearest to `p`, in body B's axes.
inline int nearest_feature(const Constraint<2>& c, const Point<double, 2>& p) {
  const auto& vertices = c.shape.vertices;
  if (c.shape.is_face()) return 0;
  const int n = static_cast<int>(vertices.size()), edges = n == 2 ? 1 : n;
  double nearest = std::numeric_limits<double>::infinity(), highest = -nearest, along = 0;
  int near_edge = 0, high_edge = 0;
  for (int k = 0; k < edges; ++k) {
    const Point<double, 2>&v = c.shape.vertex(k), &w = c.shape.vertex(k + 1);
    const double height = outward_normal(v, w).dot(p - v);
    if (height > highest) highest = height, high_edge = k;
    const double s = (p - v).dot(w - v) / (w - v).squaredNorm();
    const double distance = (p - v - std::clamp(s, 0.0, 1.0) * (w - v)).norm();
    if (distance < nearest) nearest = distance, near_edge = k, along = s;
  }
  if (n > 2 && highest <= 0) return high_edge;
  if (along > -corner_slack(c) && along < 1 + corner_slack(c)) return near_edge;
  return n + (along < 0.5 ? near_edge : (near_edge + 1) % n);
}

/// How far `p` is within the part of the plane that belongs to a feature, m; where it leaves, `next` is the feature it comes to.
inline double inside_feature(const Constraint<2>& c, int feature, const Point<double, 2>& p, int& next) {
  const Convex<2>& shape = c.shape;
  const double infinity = std::numeric_limits<double>::infinity();
  if (shape.is_face()) return infinity;
  const int n = static_cast<int>(shape.vertices.size()), k = feature % n, before = (k + n - 1) % n;
  const auto along = [&](int edge, int from) {  // of p on an edge's line, from one of its vertices
    return (p - shape.vertex(from)).dot((shape.vertex(edge + 1) - shape.vertex(edge)).normalized());
  };
  const bool is_face = feature < n;
  const double slack = corner_slack(c) * (shape.vertex(k + 1) - shape.vertex(k)).norm();
  const double first = is_face ? along(k, k) : n == 2 && k == 0 ? infinity : along(before, k);
  const double second = is_face ? -along(k, k + 1) : n == 2 && k == 1 ? infinity : -along(k, k);
  next = first < second ? (is_face ? n + k : before) : (is_face ? n + (k + 1) % n : k);
  return std::min(first, second) + (is_face ? slack : 0);
}

/// The gap between the point `a` of body A, which is at `p` in body B's axes, and one feature of the shape.
inline Gap<2> gap_to(const Constraint<2>& c, int feature, const Point<double, 2>& p) {
  const Convex<2>& shape = c.shape;
  const int n = static_cast<int>(shape.vertices.size());
  Gap<2> gap = c.gap;
  gap.offset = c.radius;
  gap.b = shape.vertex(feature);
  if (feature >= n) {
    gap.kind = GapKind::point_point;
    return gap;
  }
  gap.kind = GapKind::point_face;
  gap.n = shape.is_face() ? shape.normal : outward_normal(gap.b, shape.vertex(feature + 1));
  if (n == 2 && gap.n.dot(p - gap.b) < 0) gap.n = -gap.n;
  return gap;
}

/// In space a shape's features are not told apart by number.
inline int nearest_feature(const Constraint<3>&, const Point<double, 3>&) {
  return kNearest;
}
inline double inside_feature(const Constraint<3>&, int, const Point<double, 3>&, int&) {
  return std::numeric_limits<double>::infinity();
}
inline Gap<3> gap_to(const Constraint<3>& c, int, const Point<double, 3>& p) {
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

/// The point `a` of body A in body B's axes.
template <int D>
Point<double, D> seen_from(const Constraint<D>& c, const Pose<double, D>& A, const Pose<double, D>& B) {
  const Point<double, D> x = A.p + A.R * c.gap.a;
  return B.R.transpose() * (x - B.p);
}

/// The smooth gap that holds at these poses, to the feature that is held or to the nearest.
template <int D>
Gap<D> gap_at(const Constraint<D>& c, const Pose<double, D>& A, const Pose<double, D>& B, int held = kNearest) {
  if (c.shape.vertices.empty()) return c.gap;
  const Point<double, D> p = seen_from(c, A, B);
  return gap_to(c, held == kNearest ? nearest_feature(c, p) : held, p);
}

}  // namespace tenon::contact
