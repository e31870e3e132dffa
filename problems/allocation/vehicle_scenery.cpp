#include "tenon/problems/allocation/vehicle_scenery.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tenon {

namespace {

/// Half the distance of the two nearest rotors, less a gap: no file says how large the propellers are.
double propeller_radius(const Vehicle& vehicle) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < vehicle.rotors.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) nearest = std::min(nearest, (vehicle.rotors[i].position - vehicle.rotors[j].position).norm());
  }
  return 0.42 * nearest;
}

/// mu(u) n in the axes of the arm, where n is the direction at angle 0: each component is a polynomial in the throttle.
SceneryVector thrust(const Rotor& rotor, const std::string& throttle) {
  const auto component = [&](int k) {
    std::vector<double> coefficients = rotor.thrust;
    for (double& c : coefficients) c *= rotor.zero[k];
    return SceneryValue(throttle, coefficients);
  };
  return {component(0), component(1), component(2)};
}

/// What all rotors share, nothing where they differ or there is no limit.
std::optional<double> common(const Vehicle& vehicle, double Rotor::*limit) {
  const double first = vehicle.rotors.front().*limit;
  const bool same = std::all_of(vehicle.rotors.begin(), vehicle.rotors.end(), [&](const Rotor& rotor) { return rotor.*limit == first; });
  return same && std::isfinite(first) ? std::optional(first) : std::nullopt;
}

}  // namespace

Scenery vehicle_scenery(const Vehicle& vehicle) {
  const double radius = propeller_radius(vehicle), thick = 0.06 * radius;
  Scenery scenery;
  scenery.title = vehicle.name;
  scenery.space = Scenery::Space::spatial;
  SceneryBody frame{.name = "frame", .shapes = {SceneryShape::sphere(0.22 * radius).colored("frame")}};
  for (const Rotor& rotor : vehicle.rotors) {
    frame.shapes.push_back(SceneryShape::cylinder(Eigen::Vector3d::Zero(), rotor.position, thick).colored("frame"));
  }
  scenery.bodies.push_back(frame);

  SceneryPlot throttles{.title = "Throttles", .lower = common(vehicle, &Rotor::throttle_lower), .upper = common(vehicle, &Rotor::throttle_upper)};
  SceneryPlot angles{.title = "Arm angles", .unit = "rad", .lower = common(vehicle, &Rotor::angle_lower), .upper = common(vehicle, &Rotor::angle_upper)};
  SceneryArrow total{.name = "force", .at = {.body = "frame"}};
  for (std::size_t i = 0; i < vehicle.rotors.size(); ++i) {
    const Rotor& rotor = vehicle.rotors[i];
    const std::string number = std::to_string(i + 1), arm = "arm " + number, arrow = "thrust " + number;
    const Eigen::Vector3d above = 1.6 * thick * rotor.zero;
    SceneryBody body{.name = arm, .parent = "frame", .position = scenery_vector(rotor.position), .angle = SceneryValue("a" + number)};
    body.axis = rotor.axis;
    body.shapes = {SceneryShape::cylinder(-2 * above, above, 1.8 * thick).colored("arm"),
                   SceneryShape::cylinder(above, 1.25 * above, radius).colored("rotor")};
    scenery.bodies.push_back(body);
    scenery.arrows.push_back({.name = arrow, .at = {.body = arm}, .vector = thrust(rotor, "u" + number)});
    total.sum.push_back(arrow);
    throttles.columns.push_back("u" + number);
    angles.columns.push_back("a" + number);
  }
  scenery.arrows.push_back(total);
  scenery.plots = {throttles, angles};
  return scenery;
}

}  // namespace tenon
