#include "tenon/problems/flight/mission_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <numbers>

#include "tenon/core/named_file.hpp"
#include "tenon/core/nearest_name.hpp"
#include "tenon/problems/allocation/vehicle_error.hpp"
#include "tenon/problems/allocation/vehicle_file.hpp"
#include "tenon/problems/toml/checked_keys.hpp"
#include "tenon/problems/toml/document.hpp"

namespace tenon {

std::vector<EmbeddedFile> embedded_missions();  // generated from missions/*.toml

namespace flight {

namespace {

using toml_file::Table;
using Words = std::vector<std::string>;

constexpr double kDegree = std::numbers::pi / 180;

[[noreturn]] void refuse(const Table& table, const std::string& key, double value, const std::string& expected) {
  throw InputError(table.position(key), fmt::format("{} is {}", key, value), expected);
}

/// The place of a word in its list.
std::size_t choice(const Table& table, const std::string& key, const Words& words) {
  const std::string word = table.text(key);
  const auto found = std::ranges::find(words, word);
  if (found == words.end()) {
    throw InputError(table.position(key), fmt::format("{} is '{}', the nearest is '{}'", key, word, nearest_name(word, words)),
                     fmt::format("one of {}", fmt::join(words, ", ")));
  }
  return static_cast<std::size_t>(found - words.begin());
}

Vehicle read_vehicle(const Table& root) {
  const auto table = root.table("vehicle", {"model", "mass", "inertia"});
  if (!table) return load_vehicle("momav").vehicle;
  Vehicle vehicle;
  try {
    vehicle = load_vehicle(table->text("model", "momav")).vehicle;
  } catch (const std::invalid_argument& error) {
    throw InputError(table->position("model"), error.what());
  }
  vehicle.mass = positive(*table, "mass", vehicle.mass);
  vehicle.inertia = table->vector3("inertia", vehicle.inertia);
  return vehicle;
}

void read_legs(const Table& table, Mission& mission) {
  ReferencePath& path = mission.reference;
  Vector3d position = path.position;
  double duration = 0;
  for (const Table& leg : table.tables("leg", {"duration", "position", "turn_deg"})) {
    position = leg.vector3("position", position);
    leg.number("duration");  // there is no leg without
    path.legs.push_back({not_negative(leg, "duration", 0), position, kDegree * leg.vector3("turn_deg", Vector3d::Zero())});
    duration += path.legs.back().duration;
  }
  if (duration > 0) mission.duration = duration;
}

void read_reference(const Table& root, Mission& mission) {
  const Words known{"kind", "position", "turn_deg", "rate_deg", "ramp", "period", "size", "tilt_deg", "leg"};
  const auto table = root.table("reference", known);
  if (!table) throw InputError(root.position(), "there is no [reference]", "where the vehicle should be");
  ReferencePath& path = mission.reference;
  path.kind = static_cast<ReferencePath::Kind>(choice(*table, "kind", {"legs", "tumble", "figure-eight"}));
  path.position = table->vector3("position", path.position);
  path.attitude = rotation_of(kDegree * table->vector3("turn_deg", Vector3d::Zero()));
  path.ramp = positive(*table, "ramp", path.ramp);
  switch (path.kind) {
    case ReferencePath::Kind::legs:
      return read_legs(*table, mission);
    case ReferencePath::Kind::tumble:
      path.rate = kDegree * table->number("rate_deg");
      return;
    case ReferencePath::Kind::figure_eight:
      table->number("period");  // there is no figure-eight without
      path.rate = 2 * std::numbers::pi / positive(*table, "period", 1);
      path.size = table->number("size");
      path.tilt = kDegree * table->number("tilt_deg", 0);
      return;
  }
}

void read_gains(const Table& table, const std::string& key, Gains& gains) {
  if (table.has(key)) {
    const Vector3d g = table.vector3(key);
    if (g.minCoeff() < 0)
      throw InputError(table.position(key), fmt::format("{} is [{}, {}, {}]", key, g[0], g[1], g[2]), "no gain below 0");
    gains.proportional = g[0], gains.integral = g[1], gains.derivative = g[2];
  }
  gains.integral_limit = not_negative(table, key + "_integral_limit", gains.integral_limit);
}

void read_controller(const Table& root, Mission& mission) {
  PoseControllerOptions& options = mission.controller;
  options.body = {mission.vehicle.mass, mission.vehicle.inertia, mission.vehicle.gravity};
  options.actuator_lag = (mission.actuators.rotor_lag + mission.actuators.servo_lag) / 2;
  const auto table = root.table("controller", {"rate", "force", "torque", "force_integral_limit", "torque_integral_limit", "feedback_limit",
                                               "observer", "disturbance", "mass", "actuator_lag", "lag_compensation"});
  if (table) {
    options.period = 1 / positive(*table, "rate", 1 / options.period);
    read_gains(*table, "force", options.force);
    read_gains(*table, "torque", options.torque);
    options.feedback_limit = positive(*table, "feedback_limit", options.feedback_limit);
    options.observer_bandwidth = positive(*table, "observer", options.observer_bandwidth);
    options.disturbance_share = table->number("disturbance", options.disturbance_share);
    options.body.mass = positive(*table, "mass", options.body.mass);
    options.actuator_lag = not_negative(*table, "actuator_lag", options.actuator_lag);
    // (4.4) the lag, half of the hold, the delay
    if (table->flag("lag_compensation", false)) options.lead = options.actuator_lag + options.period * (0.5 + mission.sensors.delay);
  }
  options.actuator_lag += options.period * mission.sensors.delay;
  try {
    validate(options);
  } catch (const std::invalid_argument& error) {
    throw InputError(table ? table->position() : root.position(), error.what());
  }
}

void read_surroundings(const Table& root, Mission& mission) {
  if (const auto table = root.table("sensors", {"position_noise", "attitude_noise_deg", "delay", "drop_out"})) {
    Sensors& sensors = mission.sensors;
    sensors.position_noise = not_negative(*table, "position_noise", 0);
    sensors.attitude_noise = kDegree * not_negative(*table, "attitude_noise_deg", 0);
    sensors.drop_out = not_negative(*table, "drop_out", 0);
    sensors.delay = table->integer("delay", 0);
    if (!(sensors.drop_out < 1)) refuse(*table, "drop_out", sensors.drop_out, "a probability below 1");
    if (sensors.delay < 0 || sensors.delay > 240) refuse(*table, "delay", sensors.delay, "0 to 240 ticks");
  }
  if (const auto table = root.table("actuators", {"rotor_lag", "servo_lag"})) {
    mission.actuators.rotor_lag = positive(*table, "rotor_lag", mission.actuators.rotor_lag);
    mission.actuators.servo_lag = positive(*table, "servo_lag", mission.actuators.servo_lag);
  }
  if (const auto table = root.table("wind", {"steady", "deviation", "correlation"})) {
    mission.wind.steady = table->vector3("steady", Vector3d::Zero());
    mission.wind.deviation = not_negative(*table, "deviation", 0);
    mission.wind.correlation = positive(*table, "correlation", mission.wind.correlation);
  }
  if (const auto table = root.table("payload", {"mass"})) mission.payload = not_negative(*table, "mass", 0);
  for (int i = 0; i < mission.vehicle.num_rotors(); ++i) {  // those that stand in the vehicle's own file
    const Rotor& rotor = mission.vehicle.rotors[static_cast<std::size_t>(i)];
    if (std::isfinite(rotor.fails_at)) mission.failures.push_back({Failure::Kind::rotor, i, rotor.fails_at});
    if (std::isfinite(rotor.servo_sticks_at)) mission.failures.push_back({Failure::Kind::servo, i, rotor.servo_sticks_at});
  }
  for (const Table& table : root.tables("failure", {"kind", "rotor", "t", "detection"})) {
    Failure failure;
    failure.kind = static_cast<Failure::Kind>(choice(table, "kind", {"rotor", "servo"}));
    const int rotor = table.integer("rotor"), most = mission.vehicle.num_rotors();
    if (rotor < 1 || rotor > most) refuse(table, "rotor", rotor, fmt::format("1 to {}", most));
    failure.rotor = rotor - 1;
    failure.t = table.number("t");
    failure.detection = not_negative(table, "detection", failure.detection);
    mission.failures.push_back(failure);
  }
}

void read_simulation(const Table& root, Mission& mission) {
  const auto table = root.table("simulation", {"duration", "rtol", "output_ticks", "lost"});
  const bool is_given = table && table->has("duration");
  if (!is_given && mission.reference.legs.empty())
    throw InputError(table ? table->position() : root.position(), "there is no duration", "legs, or a duration in [simulation]");
  if (!table) return;
  mission.duration = positive(*table, "duration", mission.duration);
  mission.rtol = positive(*table, "rtol", mission.rtol);
  mission.lost = positive(*table, "lost", mission.lost);
  mission.output_ticks = table->integer("output_ticks", mission.output_ticks);
  if (mission.output_ticks < 1) refuse(*table, "output_ticks", mission.output_ticks, "1 or more");
}

}  // namespace

Mission parse_mission(const std::string& text, const std::string& file, const std::vector<std::string>& overrides) {
  const Table root =
      toml_file::Document(text, file, overrides)
          .root({"name", "vehicle", "reference", "controller", "sensors", "actuators", "wind", "failure", "payload", "simulation"});
  Mission mission;
  mission.name = root.text("name", std::filesystem::path(file).stem().string());
  mission.vehicle = read_vehicle(root);
  read_reference(root, mission);
  read_surroundings(root, mission);
  read_controller(root, mission);
  read_simulation(root, mission);
  return mission;
}

std::vector<std::string> builtin_missions() {
  return names_of(embedded_missions());
}

std::string describe_builtin_mission(const std::string& name) {
  return description_of(name, embedded_missions());
}

Mission load_mission(const std::string& name_or_path, const std::vector<std::string>& overrides) {
  const NamedFile file = open_named_file("mission", name_or_path, embedded_missions());
  return parse_mission(file.text, file.name, overrides);
}

}  // namespace flight
}  // namespace tenon
