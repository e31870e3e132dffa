#include "tenon/problems/peg_in_hole/geometry.hpp"

#include <cmath>
#include <numbers>

namespace tenon::peg {

namespace {

struct Turn {
  explicit Turn(double theta) : c(std::cos(theta)), s(std::sin(theta)) {}
  Vector2d out(const Vector2d& v) const { return {c * v[0] - s * v[1], s * v[0] + c * v[1]}; }
  Vector2d in(const Vector2d& v) const { return {c * v[0] + s * v[1], -s * v[0] + c * v[1]}; }
  double c, s;
};

/// n . p + offset in the hole's axes, p a corner of the peg:  hole' R(-theta_h) (q + R(theta) corner - o)                             (1.3)
Jet corner_face(const Geometry& g, const Vector3d& pose, const Vector3d& hole, double corner, const Vector2d& n, double offset,
                const Vector3d& y) {
  const Turn of_hole(hole[2] / g.lever), between((pose[2] - hole[2]) / g.lever);
  const Vector2d normal = of_hole.out(n), arm = corner * Vector2d(between.c, between.s), turned = corner * Vector2d(-between.s, between.c);
  const double along_arm = n.dot(arm), along_turned = n.dot(turned), by_phi = 1 / g.lever;
  Jet jet;
  jet.value = normal.dot(pose.head<2>() - hole.head<2>()) + along_arm + offset;
  jet.gradient << normal, along_turned * by_phi;
  jet.hessian.setZero();
  jet.hessian(2, 2) = -along_arm * by_phi * by_phi;
  jet.along.setZero();
  jet.along(2, 2) = -along_turned * by_phi * by_phi * by_phi * y[2];
  return jet;
}

/// n . b + offset in the peg's axes, b = R(-theta) (o + R(theta_h) vertex - q)                                                       (1.4)
Jet vertex_face(const Geometry& g, const Vector3d& pose, const Vector3d& hole, const Vector2d& vertex, const Vector2d& n, double offset,
                const Vector3d& y) {
  const Turn of_hole(hole[2] / g.lever), of_peg(pose[2] / g.lever);
  const Vector2d from_peg = hole.head<2>() + of_hole.out(vertex) - pose.head<2>();
  const Vector2d normal = of_peg.out(n), turned(-normal[1], normal[0]);  // d normal / d theta
  const double by_phi = 1 / g.lever, along = normal.dot(from_peg), across = turned.dot(from_peg);
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

/// Calls join(jets...) with the faces of a contact's convex pair.
template <class Join>
auto with_faces(const Geometry& g, int contact, const Vector3d& pose, const Vector3d& hole, const Vector3d& y, Join&& join) {
  const double s = side_of(contact), half = g.half_opening();
  if (contact < 2) {
    const double corner = s * g.width / 2;
    constexpr double kDiagonal = 1 / std::numbers::sqrt2;
    return join(corner_face(g, pose, hole, corner, {-s, 0}, half, y),
                corner_face(g, pose, hole, corner, {-s * kDiagonal, kDiagonal}, (half + g.chamfer) * kDiagonal, y),
                corner_face(g, pose, hole, corner, {0, 1}, 0, y));
  }
  const Vector2d vertex = contact < 4 ? Vector2d(s * half, -g.chamfer) : Vector2d(s * (half + g.chamfer), 0);
  return join(vertex_face(g, pose, hole, vertex, {s, 0}, -g.width / 2, y), vertex_face(g, pose, hole, vertex, {0, -1}, 0, y));
}

Vector2d contact_point(const Geometry& g, int contact, const Vector3d& pose, const Vector3d& hole) {
  const double s = side_of(contact), half = g.half_opening();
  if (contact < 2) return pose.head<2>() + Turn(pose[2] / g.lever).out({s * g.width / 2, 0});
  return hole.head<2>() + Turn(hole[2] / g.lever).out(contact < 4 ? Vector2d(s * half, -g.chamfer) : Vector2d(s * (half + g.chamfer), 0));
}

}  // namespace

Jet smooth_gap(const Geometry& g, double delta, int contact, const Vector3d& pose, const Vector3d& hole, const Vector3d& y) {
  const auto join = [&](const auto& first, const auto& second, const auto&... third) {
    Jet jet = smax(first, second, delta, y);
    ((jet = smax(jet, third, delta, y)), ...);
    return jet;
  };
  return with_faces(g, contact, pose, hole, y, join);
}

Jet smooth_gap(const Geometry& g, double delta, int contact, const Vector3d& pose, const Vector3d& hole) {
  return smooth_gap(g, delta, contact, pose, hole, Vector3d::Zero());
}

ExactGap exact_gap(const Geometry& g, int contact, const Vector3d& pose, const Vector3d& hole) {
  const auto join = [](const auto& first, const auto&... rest) {
    const Jet* largest = &first;
    ((largest = rest.value > largest->value ? &rest : largest), ...);
    return *largest;
  };
  const Jet face = with_faces(g, contact, pose, hole, Vector3d::Zero(), join);
  const Vector2d along(-face.gradient[1], face.gradient[0]), arm = contact_point(g, contact, pose, hole) - pose.head<2>();
  return {face.value, face.gradient, {along[0], along[1], (arm[0] * along[1] - arm[1] * along[0]) / g.lever}};
}

double depth(const Geometry& g, const Vector3d& pose, const Vector3d& hole) {
  return -Turn(hole[2] / g.lever).in(pose.head<2>() - hole.head<2>())[1];
}

}  // namespace tenon::peg
