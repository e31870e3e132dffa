#include "tenon/problems/delta/scene_scenery.hpp"

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

/// lambda n on the wrist.
void add_contact(const Contact& contact, double size, Scenery& scenery) {
  const std::string force = "lambda_" + contact.name;
  SceneryVector vector;
  for (int k = 0; k < 3; ++k) vector[static_cast<std::size_t>(k)] = SceneryValue(force, {0, contact.normal[k]});
  scenery.arrows.push_back({.name = contact.name, .at = {.body = "wrist"}, .vector = vector, .frame = "world"});
  if (contact.is_finger) return;
  // the wall's face, gap = normal . z + offset = 0, as a plate behind it
  const double thick = 0.05 * size;
  const Vector3d middle = -(contact.offset + thick / 2) * contact.normal;
  const Vector3d axis = Vector3d::UnitZ().cross(contact.normal);
  const double angle = std::atan2(axis.norm(), contact.normal[2]);
  const SceneryShape plate = SceneryShape::box(Vector3d(size, size, thick));
  SceneryBody wall{.name = contact.name, .position = scenery_vector(middle)};
  wall.shapes = {plate.at(Vector3d::Zero(), angle, axis.norm() > 0 ? Vector3d(axis.normalized()) : Vector3d(Vector3d::UnitX())).colored("ground")};
  scenery.bodies.push_back(wall);
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
  for (const Contact& contact : scene.contacts) add_contact(contact, robot.proximal_length + robot.base_radius, scenery);
  if (scene.control != ControlMode::none) {
    SceneryBody reference{.name = "reference", .position = {"rx", "ry", "rz"}};
    reference.shapes = {SceneryShape::sphere(0.6 * thick).colored("force")};
    scenery.bodies.push_back(reference);
    SceneryPlot torques{.title = "Motor torques", .unit = "N m", .columns = {"tau1", "tau2", "tau3"}};
    if (std::isfinite(robot.torque_limit)) torques.lower = -robot.torque_limit, torques.upper = robot.torque_limit;
    scenery.plots.push_back(torques);
  }
  scenery.plots.push_back({.title = "Distance from singularities (0 is at one)", .columns = {"type_1", "det_a"}});
  return scenery;
}

}  // namespace tenon::delta
