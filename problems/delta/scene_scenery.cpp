#include "tenon/problems/delta/scene_scenery.hpp"

#include <algorithm>
#include <cmath>

#include "tenon/problems/delta/configuration.hpp"

namespace tenon::delta {

namespace {

using Eigen::Vector3d;

void add_arm(const Robot& robot, int i, Scenery& scenery) {
  const std::string number = std::to_string(i + 1), plane = "arm " + number, proximal = "proximal " + number;
  const double thick = 0.04 * robot.proximal_length, apart = 0.5 * robot.wrist_radius;
  const Vector3d lateral = to_world(i, Vector3d::UnitX());
  scenery.bodies.push_back({.name = plane, .angle = SceneryValue(std::atan2(lateral[1], lateral[0]))});
  SceneryBody link{.name = proximal, .parent = plane, .position = {0, robot.base_radius, 0}, .angle = SceneryValue("q" + number + "1")};
  link.axis = Vector3d::UnitX();
  link.shapes = {SceneryShape::cylinder(Vector3d::Zero(), Vector3d(0, robot.proximal_length, 0), thick).colored("arm"),
                 SceneryShape::cylinder(Vector3d(-2 * thick, 0, 0), Vector3d(2 * thick, 0, 0), 2 * thick).colored("frame")};
  scenery.bodies.push_back(link);
  for (const double side : {-apart, apart}) {  // the distal link is two parallel rods, so that the wrist keeps its attitude
    scenery.links.push_back({.kind = SceneryLink::Kind::rod,
                             .from = {.body = proximal, .at = {side, robot.proximal_length, 0}},
                             .to = {.body = "wrist", .at = scenery_vector(to_world(i, Vector3d(side, robot.wrist_radius, 0)))}});
  }
}

/// A box whose first axis lies along `direction`.
SceneryShape box_along(const Vector3d& direction, const Vector3d& size) {
  const Vector3d axis = Vector3d::UnitX().cross(direction);
  const double angle = std::atan2(axis.norm(), direction[0]);
  return SceneryShape::box(size).at(Vector3d::Zero(), angle, axis.norm() > 0 ? Vector3d(axis.normalized()) : Vector3d(Vector3d::UnitZ()));
}

/// The wall's face, gap = normal . z + offset = 0, as a plate behind it.
void add_wall(const Contact& contact, double size, Scenery& scenery) {
  const double thick = 0.05 * size;
  SceneryBody wall{.name = contact.name, .position = scenery_vector(-(contact.offset + thick / 2) * contact.normal)};
  wall.shapes = {box_along(contact.normal, {thick, size, size}).colored("ground")};
  scenery.bodies.push_back(wall);
}

/// What the fingers hold, a hand below where the wrist starts: it moves along the tactile axis.
void add_object(const Scene& scene, double half_width, Scenery& scenery) {
  const Vector3d& axis = scene.controller.tactile_axis;
  Vector3d middle = scene.position - axis.dot(scene.position) * axis;
  middle[2] += 1.2 * scene.robot.wrist_radius;
  SceneryBody object{.name = "object", .position = scenery_vector(middle)};
  if (scene.object.mass > 0) {
    for (int k = 0; k < 3; ++k) object.position[static_cast<std::size_t>(k)] = SceneryValue("object", {middle[k], axis[k]});
  }
  object.shapes = {box_along(axis, {2 * half_width, 1.6 * half_width, 1.6 * half_width})};
  scenery.bodies.push_back(object);
}

/// A finger hangs from the wrist; its face stands gap - offset beside the object's middle.
void add_finger(const Contact& contact, double wrist_radius, Scenery& scenery) {
  const double thick = 0.1 * wrist_radius, height = 0.8 * wrist_radius;
  SceneryBody finger{.name = contact.name, .parent = "object"};
  for (int k = 0; k < 3; ++k) {
    finger.position[static_cast<std::size_t>(k)] =
        SceneryValue("gap_" + contact.name, {(thick / 2 - contact.offset) * contact.normal[k], contact.normal[k]});
  }
  finger.shapes = {box_along(contact.normal, {thick, height, height}).colored("arm")};
  scenery.bodies.push_back(finger);
  scenery.links.push_back({.kind = SceneryLink::Kind::rod,
                           .from = {.body = "wrist", .at = scenery_vector(0.9 * wrist_radius * contact.normal)},
                           .to = {.body = contact.name, .at = {0, 0, -height / 2}}});
}

void add_contact(const Scene& scene, const Contact& contact, Scenery& scenery) {
  const Robot& robot = scene.robot;
  if (contact.is_finger)
    add_finger(contact, robot.wrist_radius, scenery);
  else
    add_wall(contact, robot.proximal_length + robot.base_radius, scenery);
  SceneryVector force;  // lambda n on the wrist
  for (int k = 0; k < 3; ++k) force[static_cast<std::size_t>(k)] = SceneryValue("lambda_" + contact.name, {0, contact.normal[k]});
  scenery.arrows.push_back(
      {.name = contact.name, .at = {.body = contact.is_finger ? contact.name : "wrist"}, .vector = force, .frame = "world"});
}

/// Yaw, pitch and roll, one in the other; the last one carries a tool.
void add_tool(const Robot& robot, Scenery& scenery) {
  std::string parent = "wrist";
  const char* const names[] = {"yaw", "pitch", "roll"};
  for (int k = 0; k < 3; ++k) {
    SceneryBody gimbal{.name = names[k], .parent = parent, .angle = SceneryValue(names[k])};
    gimbal.axis = Vector3d::Unit(2 - k);
    parent = gimbal.name;
    scenery.bodies.push_back(gimbal);
  }
  const double length = 1.6 * robot.wrist_radius, radius = 0.2 * robot.wrist_radius;
  scenery.bodies.back().shapes = {SceneryShape::cylinder(Vector3d::Zero(), Vector3d(0, 0, length), radius).colored("arm"),
                                  SceneryShape::box(Vector3d(3 * radius, radius, radius)).at(Vector3d(0, 0, length)).colored("frame")};
}

}  // namespace

Scenery scene_scenery(const Scene& scene) {
  const Robot& robot = scene.robot;
  const double thick = 0.04 * robot.proximal_length;
  Scenery scenery;
  scenery.title = scene.name;
  scenery.space = Scenery::Space::spatial;
  scenery.up = Vector3d(0, 0, -1);
  scenery.camera_direction = Vector3d(1, 0.55, -0.25);

  SceneryBody base{.name = "base"};
  base.shapes = {SceneryShape::cylinder(Vector3d(0, 0, -1.5 * thick), Vector3d(0, 0, -0.5 * thick), robot.base_radius).colored("frame")};
  scenery.bodies.push_back(base);
  SceneryBody wrist{.name = "wrist", .position = {"zx", "zy", "zz"}};
  wrist.shapes = {SceneryShape::cylinder(Vector3d(0, 0, -thick / 2), Vector3d(0, 0, thick / 2), robot.wrist_radius).colored("frame")};
  wrist.trail = true;
  scenery.bodies.push_back(wrist);
  for (int i = 0; i < 3; ++i) add_arm(robot, i, scenery);
  if (const auto finger = std::ranges::find_if(scene.contacts, &Contact::is_finger); finger != scene.contacts.end()) {
    add_object(scene, std::abs(finger->offset), scenery);
  }
  for (const Contact& contact : scene.contacts) add_contact(scene, contact, scenery);
  if (scene.has_tool) add_tool(robot, scenery);
  if (scene.control != ControlMode::none) {
    SceneryBody reference{.name = "reference", .position = {"rx", "ry", "rz"}};
    reference.shapes = {SceneryShape::sphere(0.6 * thick).colored("force")};
    scenery.bodies.push_back(reference);
    for (const std::string axis : {"x", "y", "z"})
      scenery.plots.push_back({.title = "Wrist along " + axis + ": wanted and actual", .unit = "m", .columns = {"r" + axis, "z" + axis}});
    scenery.plots.push_back({.title = "Distance from the reference", .unit = "m", .columns = {"tracking_error"}});
    SceneryPlot torques{.title = "Motor torques", .unit = "N m", .columns = {"tau1", "tau2", "tau3"}};
    if (std::isfinite(robot.torque_limit)) torques.lower = -robot.torque_limit, torques.upper = robot.torque_limit;
    scenery.plots.push_back(torques);
  }
  scenery.plots.push_back({.title = "Distance from singularities (0 is at one)", .columns = {"type_1", "det_a"}});
  return scenery;
}

}  // namespace tenon::delta
