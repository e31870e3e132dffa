// The shapes of a scene file.
#include <algorithm>
#include <cmath>

#include "tenon/problems/contact/scene_reader.hpp"

namespace tenon::contact {

namespace {

/// The corners of a box of this size about the centre, turned by an angle, counter-clockwise.
std::vector<Point<double, 2>> corners(const Point<double, 2>& centre, const Point<double, 2>& size, double angle) {
  const Eigen::Rotation2Dd turn(angle);
  std::vector<Point<double, 2>> list;
  for (const auto& [x, y] : {std::pair(-0.5, -0.5), std::pair(0.5, -0.5), std::pair(0.5, 0.5), std::pair(-0.5, 0.5)})
    list.push_back(centre + turn * Point<double, 2>(x * size[0], y * size[1]));
  return list;
}

std::vector<Point<double, 3>> corners(const Point<double, 3>& centre, const Point<double, 3>& size) {
  std::vector<Point<double, 3>> list;
  for (int k = 0; k < 8; ++k) {
    const Point<double, 3> side(k & 1 ? 0.5 : -0.5, k & 2 ? 0.5 : -0.5, k & 4 ? 0.5 : -0.5);
    list.push_back(centre + side.cwiseProduct(size));
  }
  return list;
}

/// A hole with a chamfered mouth about `at`, open upwards, as the convex parts of the plate that it is in: a cheek on either side, with the
/// corners that a peg meets, and the floor.
///
///       _____              _____   y = 0
///            \            /        chamfer, at 45 degrees
///             |  width   |
///             |__________|         y = -depth
std::vector<Shape<2>> hole(const Point<double, 2>& at, double angle, double width, double depth, double chamfer, double rim) {
  const double throat = 0.5 * width, mouth = throat + chamfer, outside = mouth + rim, bottom = -depth - width;
  Shape<2> left, right, floor;
  right.convex.vertices = {{throat, bottom}, {outside, bottom}, {outside, 0}, {mouth, 0}};
  right.balls = {{{mouth, 0}, 0}};
  if (chamfer > 0) {
    right.convex.vertices.push_back({throat, -chamfer});
    right.balls.push_back({{throat, -chamfer}, 0});
  }
  floor.convex.vertices = {{-outside, bottom}, {outside, bottom}, {outside, -depth}, {-outside, -depth}};
  left = right;
  std::reverse(left.convex.vertices.begin(), left.convex.vertices.end());
  for (auto& v : left.convex.vertices) v[0] = -v[0];
  for (auto& ball : left.balls) ball.centre[0] = -ball.centre[0];
  std::vector<Shape<2>> parts{left, right, floor};
  const Eigen::Rotation2Dd turn(angle);
  for (Shape<2>& part : parts) {
    for (auto& v : part.convex.vertices) v = at + turn * v;
    for (auto& ball : part.balls) ball.centre = at + turn * ball.centre;
  }
  return parts;
}

double signed_area(const std::vector<Point<double, 2>>& vertices) {
  double sum = 0;
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    const Point<double, 2>&v = vertices[k], &w = vertices[(k + 1) % vertices.size()];
    sum += 0.5 * (v[0] * w[1] - v[1] * w[0]);
  }
  return sum;
}

bool is_convex(const std::vector<Point<double, 2>>& vertices) {
  const std::size_t n = vertices.size();
  for (std::size_t k = 0; k < n; ++k) {
    const Point<double, 2> a = vertices[(k + 1) % n] - vertices[k], b = vertices[(k + 2) % n] - vertices[(k + 1) % n];
    if (!(a[0] * b[1] - a[1] * b[0] > 0)) return false;
  }
  return true;
}

}  // namespace

template <int D>
void SceneReader<D>::read_shape(const Table& table) {
  static const std::vector<std::string> types =
      D == 2 ? std::vector<std::string>{"point", "disc", "half-plane", "segment", "capsule", "polygon", "box", "hole"}
             : std::vector<std::string>{"point", "sphere", "half-space", "capsule", "box"};
  Shape<D> shape;
  shape.body = body_of(table, "body", values_.text(table, "body", "world"));
  shape.name = values_.text(table, "name", shape.body == kWorld ? "world" : scene_.bodies[static_cast<std::size_t>(shape.body)].name);
  const std::string type = table.text("type");
  if (std::find(types.begin(), types.end(), type) == types.end()) reject_name(table, "type", "type of shape", type, types);
  const Vec at = point(table, "at", Vec::Zero());
  if constexpr (D == 2) {
    if (type == "hole") {
      const double width = positive(table, "width"), depth = positive(table, "depth");
      const double chamfer = in_interval(table, "chamfer", 0, depth, 0), rim = table.has("rim") ? positive(table, "rim") : width;
      for (Shape<2>& part : hole(at, values_.number(table, "angle", 0), width, depth, chamfer, rim)) {
        part.name = shape.name, part.body = shape.body;
        shapes_.push_back(part);
      }
      return;
    }
  }
  if (type == "point") shape.balls = {{at, 0}};
  if (type == "disc" || type == "sphere") shape.balls = {{at, positive(table, "radius")}};
  if (type == "half-plane" || type == "half-space") {
    shape.convex.vertices = {point(table, "point", Vec::Zero())};
    shape.convex.normal = direction(table, "normal");
  }
  if (type == "segment" || type == "capsule") {
    shape.rounding = type == "capsule" ? positive(table, "radius") : 0;
    const Vec from = point(table, "from"), to = point(table, "to");
    if (!((to - from).norm() > 0)) throw InputError(table.position("to"), "both ends are at one place", "ends that are apart");
    shape.convex.vertices = {from, to};
    shape.balls = {{from, shape.rounding}, {to, shape.rounding}};
  }
  if (type == "box" || type == "polygon") {
    std::vector<Vec> vertices;
    if (type == "box") {
      const Vec size = point(table, "size");
      if (!(size.minCoeff() > 0)) throw InputError(table.position("size"), "a box without size", "numbers above 0");
      if constexpr (D == 2) {
        vertices = corners(at, size, values_.number(table, "angle", 0));
        shape.convex.vertices = vertices;
      } else {
        vertices = corners(at, size);
        shape.convex.vertices = {at};
        shape.convex.half = 0.5 * size;
      }
    } else if constexpr (D == 2) {
      const std::vector<double> list = values_.numbers(table, "vertices");
      if (list.size() < 6 || list.size() % 2 != 0)
        throw InputError(table.position("vertices"), "no polygon", "[x1, y1, x2, y2, x3, y3, ...]");
      for (std::size_t k = 0; k + 1 < list.size(); k += 2) vertices.push_back({list[k], list[k + 1]});
      if (signed_area(vertices) < 0) std::reverse(vertices.begin(), vertices.end());
      if (!is_convex(vertices))
        throw InputError(table.position("vertices"), "the polygon is not convex",
                         "corners in order, turning one way; several shapes for a hollow one");
      shape.convex.vertices = vertices;
    }
    for (const Vec& v : vertices) shape.balls.push_back({v, 0});
  }
  shapes_.push_back(shape);
}

template class SceneReader<2>;
template class SceneReader<3>;

}  // namespace tenon::contact
