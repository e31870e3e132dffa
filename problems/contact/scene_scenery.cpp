#include "tenon/problems/contact/scene_scenery.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace tenon::contact {

namespace {

constexpr const char* kWorldBody = "the world";  // what stands still; a scene's own bodies may have any other name
constexpr double kPointSize = 1.0 / 25;          // of the scene: the radius that a body without size is drawn with, at most
constexpr double kPointShare = 0.4;              // of the distance to the nearest other body

template <int D>
Eigen::Vector3d spatial(const Point<double, D>& p) {
  Eigen::Vector3d out = Eigen::Vector3d::Zero();
  out.head<D>() = p;
  return out;
}

template <int D>
std::string name_of(const Scene<D>& scene, int body) {
  return body == kWorld ? kWorldBody : scene.bodies[static_cast<std::size_t>(body)].name;
}

/// The body with its pose from the columns of its number; a freedom that it has not stays where it is.
template <int D>
SceneryBody placed(const Body<D>& body, int number) {
  const std::string n = std::to_string(number);
  SceneryBody out{.name = body.name, .position = scenery_vector(spatial<D>(body.q.template head<D>()))};
  static constexpr const char* kAxes[] = {"x", "y", "z"};
  for (int k = 0; k < std::min(D, body.freedoms); ++k) out.position[static_cast<std::size_t>(k)] = kAxes[k] + n;
  if constexpr (D == 2) {
    if (body.freedoms == 3) out.angle = SceneryValue("theta" + n);
  } else {
    if (body.freedoms == 6) out.quaternion = {"qw" + n, "qx" + n, "qy" + n, "qz" + n};
  }
  return out;
}

/// How large the scene is at its start: the box around its bodies, those of their shapes that have an end, and where the world's faces are.
template <int D>
double extent(const Scene<D>& scene, const std::vector<Shape<D>>& shapes) {
  Eigen::AlignedBox<double, D> box;
  for (const Body<D>& body : scene.bodies) box.extend(Point<double, D>(body.q.template head<D>()));
  for (const Shape<D>& shape : shapes) {
    if (shape.body == kWorld) {
      if (shape.convex.is_face()) box.extend(shape.convex.vertices.front());
      continue;
    }
    const Point<double, D> centre = scene.bodies[static_cast<std::size_t>(shape.body)].q.template head<D>();
    for (const Ball<D>& ball : shape.balls) {
      box.extend(Point<double, D>((centre + ball.centre).array() + ball.radius));
      box.extend(Point<double, D>((centre + ball.centre).array() - ball.radius));
    }
  }
  return std::max(box.isEmpty() ? 0.0 : box.sizes().maxCoeff(), 1e-3);
}

template <int D>
double point_radius_of(const Scene<D>& scene, double size) {
  double radius = kPointSize * size;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double distance = (scene.bodies[i].q.template head<D>() - scene.bodies[j].q.template head<D>()).norm();
      if (distance > 0) radius = std::min(radius, kPointShare * distance);
    }
  }
  return radius;
}

SceneryShape ball_shape(double radius, const Eigen::Vector3d& at, bool is_planar) {
  return (is_planar ? SceneryShape::disc(radius) : SceneryShape::sphere(radius)).at(at);
}

template <int D>
SceneryShape drawn(const Shape<D>& shape, double point_radius) {
  const Convex<D>& convex = shape.convex;
  if (convex.vertices.empty()) {
    const Ball<D>& ball = shape.balls.front();
    return ball_shape(ball.radius > 0 ? ball.radius : point_radius, spatial<D>(ball.centre), D == 2);
  }
  if (convex.is_face()) return SceneryShape::half_space(spatial<D>(convex.normal), spatial<D>(convex.vertices.front()));
  if (convex.is_box()) return SceneryShape::box(spatial<D>(Point<double, D>(2 * convex.half))).at(spatial<D>(convex.vertices.front()));
  if (convex.vertices.size() == 2) {
    const Eigen::Vector3d from = spatial<D>(convex.vertices[0]), to = spatial<D>(convex.vertices[1]);
    return shape.rounding > 0 ? SceneryShape::capsule(from, to, shape.rounding) : SceneryShape::line({from, to});
  }
  std::vector<Eigen::Vector2d> corners;
  for (const auto& v : convex.vertices) corners.push_back(v.template head<2>());
  return SceneryShape::polygon(corners);
}

template <int D>
bool is_point(const Shape<D>& shape) {
  return shape.convex.vertices.empty() && shape.balls.front().radius == 0;
}

/// Whether a body has a shape of some size: then its feet need no dots, nor its faces a picture without end.
template <int D>
bool has_size(const std::vector<Shape<D>>& shapes, int body) {
  return std::any_of(shapes.begin(), shapes.end(),
                     [&](const Shape<D>& shape) { return shape.body == body && !is_point(shape) && !shape.convex.is_face(); });
}

/// The heaviest body, where the fastest one goes further than three times the scene.
template <int D>
void follow(const Scene<D>& scene, double size, double duration, Scenery& out) {
  const auto speed = [](const Body<D>& body) { return body.v.template head<D>().norm(); };
  const auto fastest = std::max_element(scene.bodies.begin(), scene.bodies.end(), [&](const auto& a, const auto& b) { return speed(a) < speed(b); });
  if (speed(*fastest) * duration <= 3 * size) return;
  out.camera_follows = std::max_element(scene.bodies.begin(), scene.bodies.end(), [](const auto& a, const auto& b) { return a.mass < b.mass; })->name;
  out.extent = 1.5 * size;
}

template <int D>
SceneryPoint anchor(const Scene<D>& scene, int body, const Point<double, D>& at) {
  return {.body = body == kWorld ? "" : name_of(scene, body), .at = scenery_vector(spatial<D>(at))};
}

/// lambda n, from the place on body A: the normal is that of a face of body B.
template <int D>
SceneryArrow contact_force(const Scene<D>& scene, const Constraint<D>& c) {
  const std::string column = "lambda_" + c.name;
  const Eigen::Vector3d n = spatial<D>(c.shape.normal);
  const auto component = [&](int k) { return n[k] == 0 ? SceneryValue(0) : SceneryValue(column, {0, n[k]}); };
  return {.name = c.name, .at = anchor(scene, c.a, c.gap.a), .vector = {component(0), component(1), component(2)}, .frame = name_of(scene, c.b)};
}

}  // namespace

template <int D>
Scenery scenery_of(const Scene<D>& scene, const std::vector<Shape<D>>& shapes, double duration) {
  Scenery out;
  out.title = scene.name;
  out.space = D == 2 ? Scenery::Space::planar : Scenery::Space::spatial;
  const double size = extent(scene, shapes), point_radius = point_radius_of(scene, size);
  if (scene.gravity.norm() > 0) out.up = spatial<D>(Point<double, D>(-scene.gravity.normalized()));
  follow(scene, size, duration, out);
  const auto add = [&](SceneryBody body, int index) {
    const bool sized = index != kWorld && has_size(shapes, index);
    for (const Shape<D>& shape : shapes) {
      if (shape.body == index && !(sized && (is_point(shape) || shape.convex.is_face()))) body.shapes.push_back(drawn(shape, point_radius));
    }
    if (body.shapes.empty() && index != kWorld) body.shapes.push_back(ball_shape(point_radius, Eigen::Vector3d::Zero(), D == 2));
    out.bodies.push_back(std::move(body));
  };
  add({.name = kWorldBody}, kWorld);
  for (std::size_t k = 0; k < scene.bodies.size(); ++k) add(placed(scene.bodies[k], static_cast<int>(k) + 1), static_cast<int>(k));

  for (const Constraint<D>& c : scene.constraints) {
    const bool has_ends = c.gap.kind == GapKind::point_point && c.shape.vertices.empty() && c.radius == 0;
    if (has_ends) {
      out.links.push_back({.kind = c.is_joint() ? SceneryLink::Kind::rod : SceneryLink::Kind::rope,
                           .from = anchor(scene, c.a, c.gap.a), .to = anchor(scene, c.b, c.gap.b)});
    }
    if (!c.is_joint() && c.shape.is_face()) out.arrows.push_back(contact_force(scene, c));
  }
  for (const Force<D>& force : scene.forces) {
    if (force.kind != ForceKind::spring) continue;
    out.links.push_back({.kind = SceneryLink::Kind::spring, .from = anchor(scene, force.a, force.at_a), .to = anchor(scene, force.b, force.at_b)});
  }
  return out;
}

template Scenery scenery_of<2>(const Scene<2>&, const std::vector<Shape<2>>&, double);
template Scenery scenery_of<3>(const Scene<3>&, const std::vector<Shape<3>>&, double);

}  // namespace tenon::contact
