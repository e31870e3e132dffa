#include "tenon/problems/peg_in_hole/scenery.hpp"

namespace tenon::peg {

namespace {

constexpr double kMetre = 1e-3;  // of a millimetre
constexpr double kPegLength = 40, kHoleDepth = 25, kBlock = 20;  // mm

SceneryShape block(const Geometry& g, double side) {
  const double half = g.half_opening(), outer = half + g.chamfer + kBlock;
  std::vector<Eigen::Vector2d> corners = {{side * half, -kHoleDepth}, {side * outer, -kHoleDepth}, {side * outer, 0},
                                          {side * (half + g.chamfer), 0}, {side * half, -g.chamfer}};
  for (Eigen::Vector2d& corner : corners) corner *= kMetre;
  return SceneryShape::polygon(corners).colored("ground");
}

}  // namespace

Scenery scenery_of(const Geometry& g) {
  Scenery scenery;
  SceneryBody hole{.name = "hole", .position = {"hole_x", "hole_z", 0}, .angle = SceneryValue("hole_theta")};
  hole.shapes = {block(g, -1), block(g, 1)};
  SceneryBody peg{.name = "peg", .position = {"x", "z", 0}, .angle = SceneryValue("theta"), .trail = true};
  peg.shapes = {SceneryShape::box({g.width * kMetre, kPegLength * kMetre, 0}).at({0, kPegLength * kMetre / 2, 0})};
  scenery.bodies = {hole, peg};
  scenery.extent = 0.05;
  scenery.arrows = {{.name = "contact force", .at = {.body = "peg"}, .vector = {"Fx", "Fz", 0}, .frame = "world"}};
  scenery.plots = {
      {.title = "Hole: truth and estimate", .unit = "m", .columns = {"hole_x", "estimate_hole_x", "hole_z", "estimate_hole_z"}},
      {.title = "Tilt of hole and estimate", .unit = "rad", .columns = {"hole_theta", "estimate_hole_theta", "theta"}},
      {.title = "Depth", .unit = "m", .columns = {"depth"}},
      {.title = "Contact force on the peg", .unit = "N", .columns = {"Fx", "Fz"}}};
  return scenery;
}

}  // namespace tenon::peg
