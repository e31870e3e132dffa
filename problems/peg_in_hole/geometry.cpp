#include "tenon/problems/peg_in_hole/geometry.hpp"

#include <cmath>
#include <numbers>

namespace tenon::peg {

namespace {

constexpr double kFar = 1e9;  // mm

struct Turn {
  Turn(double cosine, double sine) : c(cosine), s(sine) {}
  explicit Turn(double theta) : Turn(std::cos(theta), std::sin(theta)) {}
  Vector2d out(const Vector2d& v) const { return {c * v[0] - s * v[1], s * v[0] + c * v[1]}; }
  Vector2d in(const Vector2d& v) const { return {c * v[0] + s * v[1], -s * v[0] + c * v[1]}; }
  double c, s;
};

/// Where the peg is beside the hole: what all gaps share.
struct Placement {
  Placement(const Geometry& g, const Vector3d& pose, const Vector3d& hole)
      : of_peg(pose[2] / g.lever), of_hole(hole[2] / g.lever), from_hole(pose.head<2>() - hole.head<2>()), by_phi(1 / g.lever) {}
  Turn of_peg, of_hole;
  Vector2d from_hole;
  double by_phi;  // 1/mm, of an angle
};

/// n . p + offset in the hole's axes, p a corner of the peg:  hole' R(-theta_h) (q + R(theta) corner - o)                             (1.3)
Jet corner_face(const Placement& at, double corner, const Vector2d& n, double offset, const Vector3d& y) {
  const Vector2d normal = at.of_hole.out(n), arm = corner * Vector2d(at.of_peg.c, at.of_peg.s), turned(-arm[1], arm[0]);
  const double along_arm = normal.dot(arm), along_turned = normal.dot(turned), by_phi = at.by_phi;
  Jet jet;
  jet.value = normal.dot(at.from_hole) + along_arm + offset;
  jet.gradient << normal, along_turned * by_phi;
  jet.hessian.setZero();
  jet.hessian(2, 2) = -along_arm * by_phi * by_phi;
  jet.along.setZero();
  jet.along(2, 2) = -along_turned * by_phi * by_phi * by_phi * y[2];
  return jet;
}

/// n . b + offset in the peg's axes, b = R(-theta) (o + R(theta_h) vertex - q)                                                       (1.4)
Jet vertex_face(const Placement& at, const Vector2d& vertex, const Vector2d& n, double offset, const Vector3d& y) {
  const Vector2d from_peg = at.of_hole.out(vertex) - at.from_hole;
  const Vector2d normal = at.of_peg.out(n), turned(-normal[1], normal[0]);  // d normal / d theta
  const double by_phi = at.by_phi, along = normal.dot(from_peg), across = turned.dot(from_peg);
  Jet jet;
  jet.value = along + offset;
  jet.gradient << -normal, across * by_phi;
  jet.hessian.setZero();
  jet.hessian.topRightCorner<2, 1>() = -by_phi * turned;
  jet.hessian.bottomLeftCorner<1, 2>() = -by_phi * turned.transpose();
  jet.hessian(2, 2) = -along * by_phi * by_phi;
  const double y_theta = y[2] * by_phi;
  jet.along.setZero();
  jet.along.topRightCorner<2, 1>() = by_phi * y_theta * normal;
  jet.along.bottomLeftCorner<1, 2>() = by_phi * y_theta * normal.transpose();
  jet.along(2, 2) = by_phi * by_phi * (normal.dot(y.head<2>()) - across * y_theta);
  return jet;
}

/// (1.2), with t = a - b, s = sqrt(t^2 + delta^2), kappa = delta^2 / (2 s^3)                                                         (1.5)
Jet smax(const Jet& a, const Jet& b, double delta, const Vector3d& y) {
  const double t = a.value - b.value, s = std::sqrt(t * t + delta * delta);
  const double alpha = (1 + t / s) / 2, beta = (1 - t / s) / 2, kappa = delta * delta / (2 * s * s * s);
  const Vector3d g = a.gradient - b.gradient;
  const Matrix3d h = a.hessian - b.hessian;
  const Vector3d h_y = h * y;
  const double g_y = g.dot(y);
  Jet out;
  out.value = (a.value + b.value + s) / 2;
  out.gradient = alpha * a.gradient + beta * b.gradient;
  out.hessian = alpha * a.hessian + beta * b.hessian + kappa * g * g.transpose();
  out.along = alpha * a.along + beta * b.along + kappa * (g_y * h + h_y * g.transpose() + g * h_y.transpose()) -
              (3 * kappa * t / (s * s) * g_y) * g * g.transpose();
  return out;
}

/// A face as a distance n . p + offset of a point p, in the axes of the body that has the face.
struct Face {
  Vector2d n{0, 0};
  double offset = 0;
};
/// A contact's convex pair: a point of one body, in its axes, and the faces of the other.
struct Pair {
  Vector2d point;
  std::array<Face, 3> face;
  int faces;
};
constexpr bool is_corner(int contact) {
  return contact < 2;
}

Pair pair_of(const Geometry& g, int contact) {
  const double s = side_of(contact), half = g.half_opening();
  constexpr double kDiagonal = 1 / std::numbers::sqrt2;
  if (is_corner(contact)) {
    return {{s * g.width / 2, 0},
            {Face{{-s, 0}, half}, Face{{-s * kDiagonal, kDiagonal}, (half + g.chamfer) * kDiagonal}, Face{{0, 1}, 0}},
            3};
  }
  const Vector2d vertex = contact < 4 ? Vector2d(s * half, -g.chamfer) : Vector2d(s * (half + g.chamfer), 0);
  return {vertex, {Face{{s, 0}, -g.width / 2}, Face{{0, -1}, 0}}, 2};
}

}  // namespace

std::array<Jet, kContacts> smooth_gaps(const Geometry& g, double delta, const Vector3d& pose, const Vector3d& hole, const Vector3d& y) {
  const Placement at(g, pose, hole);
  std::array<Jet, kContacts> gaps;
  for (int i = 0; i < kContacts; ++i) {
    const Pair pair = pair_of(g, i);
    const auto jet_of = [&](const Face& face) {
      return is_corner(i) ? corner_face(at, pair.point[0], face.n, face.offset, y) : vertex_face(at, pair.point, face.n, face.offset, y);
    };
    Jet jet = jet_of(pair.face[0]);
    for (int k = 1; k < pair.faces; ++k) jet = smax(jet, jet_of(pair.face[static_cast<std::size_t>(k)]), delta, y);
    gaps[static_cast<std::size_t>(i)] = jet;
  }
  return gaps;
}

std::array<ExactGap, kContacts> exact_gaps(const Geometry& g, const Vector3d& pose, const Vector3d& hole) {
  const Placement at(g, pose, hole);
  const auto cross = [](const Vector2d& a, const Vector2d& b) { return a[0] * b[1] - a[1] * b[0]; };
  std::array<ExactGap, kContacts> gaps;
  for (int i = 0; i < kContacts; ++i) {
    const Pair pair = pair_of(g, i);
    const bool corner = is_corner(i);
    const Vector2d arm = corner ? at.of_peg.out(pair.point) : Vector2d(at.of_hole.out(pair.point) - at.from_hole);
    const Vector2d seen = corner ? at.of_hole.in(at.from_hole + arm) : at.of_peg.in(arm);  // from the body with the faces
    double largest = -kFar;
    Vector2d n(0, 0);
    for (int k = 0; k < pair.faces; ++k) {
      const Face& face = pair.face[static_cast<std::size_t>(k)];
      const double value = face.n.dot(seen) + face.offset;
      if (value > largest) largest = value, n = face.n;
    }
    const Vector2d normal = corner ? at.of_hole.out(n) : Vector2d(-at.of_peg.out(n)), tangent(-normal[1], normal[0]);
    gaps[static_cast<std::size_t>(i)] = {largest,
                                         {normal[0], normal[1], cross(arm, normal) / g.lever},
                                         {tangent[0], tangent[1], cross(arm, tangent) / g.lever}};
  }
  return gaps;
}

double depth(const Geometry& g, const Vector3d& pose, const Vector3d& hole) {
  return -Turn(hole[2] / g.lever).in(pose.head<2>() - hole.head<2>())[1];
}

}  // namespace tenon::peg
