#include "tenon/problems/flight/flight_scenery.hpp"

#include <cmath>

#include "tenon/problems/allocation/vehicle_scenery.hpp"

namespace tenon::flight {

namespace {

constexpr const char* kGhost = "#b0b6c0";

SceneryBody ghost_of(const Vehicle& vehicle) {
  SceneryBody ghost{.name = "reference", .position = {"x_ref", "y_ref", "z_ref"}};
  ghost.quaternion = {"qw_ref", "qx_ref", "qy_ref", "qz_ref"};
  for (const Rotor& rotor : vehicle.rotors) {
    ghost.shapes.push_back(SceneryShape::line({Vector3d::Zero(), rotor.position}).colored(kGhost));
  }
  return ghost;
}

/// One column for each rotor.
std::vector<std::string> columns(int rotors, const std::string& before, const std::string& after) {
  std::vector<std::string> names;
  for (int i = 1; i <= rotors; ++i) names.push_back(before + std::to_string(i) + after);
  return names;
}

}  // namespace

Scenery flight_scenery(const Mission& mission) {
  const int n = mission.vehicle.num_rotors();
  Scenery scenery = vehicle_scenery(mission.vehicle);
  scenery.title = mission.name + ": " + mission.vehicle.name;
  SceneryBody& frame = scenery.bodies.front();
  frame.position = {"x", "y", "z"};
  frame.quaternion = {"qw", "qx", "qy", "qz"};
  frame.trail = true;
  scenery.bodies.push_back(ghost_of(mission.vehicle));
  if (mission.wind.deviation > 0 || !mission.wind.steady.isZero())
    scenery.arrows.push_back({.name = "wind", .at = {.body = "frame"}, .vector = {"wind_x", "wind_y", "wind_z"}, .frame = "world"});

  SceneryPlot rates{.title = "Arm rates", .unit = "rad/s", .columns = columns(n, "a", "_rate")};
  if (const double limit = mission.vehicle.rotors.front().angle_rate_limit; std::isfinite(limit)) rates.lower = -limit, rates.upper = limit;
  scenery.plots.insert(scenery.plots.begin(), {{.title = "Position error", .unit = "m", .columns = {"position_error"}},
                                               {.title = "Angle error", .unit = "rad", .columns = {"angle_error"}}});
  scenery.plots.push_back(rates);
  scenery.plots.push_back({.title = "Throttles asked", .columns = columns(n, "u", "_command")});
  scenery.plots.push_back({.title = "Arm angles asked", .unit = "rad", .columns = columns(n, "a", "_command")});
  scenery.plots.push_back({.title = "Reference", .unit = "m", .columns = {"x_ref", "y_ref", "z_ref"}});
  scenery.plots.push_back({.title = "Force asked", .unit = "N", .columns = {"Fx_asked", "Fy_asked", "Fz_asked"}});
  scenery.plots.push_back({.title = "Torque asked", .unit = "N m", .columns = {"Mx_asked", "My_asked", "Mz_asked"}});
  scenery.plots.push_back({.title = "Wind", .unit = "N", .columns = {"wind_x", "wind_y", "wind_z"}});
  return scenery;
}

}  // namespace tenon::flight
