#include "tenon/problems/allocation/vehicle_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "tenon/core/embedded_file.hpp"
#include "tenon/core/nearest_name.hpp"
#include "tenon/core/read_file.hpp"
#include "tenon/problems/allocation/vehicle_error.hpp"
#include "tenon/problems/toml/document.hpp"

namespace tenon {

std::vector<EmbeddedFile> embedded_vehicles();  // generated from vehicles/*.toml

namespace {

using toml_file::Table;

struct WeightKey {
  const char* name;
  double AllocationWeights::*field;
};

constexpr WeightKey kWeightKeys[] = {
    {"throttle", &AllocationWeights::throttle},
    {"throttle_penalty", &AllocationWeights::throttle_penalty},
    {"throttle_soft_lower", &AllocationWeights::throttle_soft_lower},
    {"throttle_soft_upper", &AllocationWeights::throttle_soft_upper},
    {"angle_rate", &AllocationWeights::angle_rate},
    {"angle_rate_penalty", &AllocationWeights::angle_rate_penalty},
    {"angle_rate_soft", &AllocationWeights::angle_rate_soft},
    {"branch", &AllocationWeights::branch},
    {"force_error", &AllocationWeights::force_error},
    {"torque_error", &AllocationWeights::torque_error},
};

const std::vector<std::string> kRootKeys{"name", "mass", "inertia", "gravity", "limits", "weights", "solver", "rotor"};
const std::vector<std::string> kRotorKeys{"position",         "axis", "zero",     "spin",           "thrust", "torque", "throttle", "angle",
                                          "angle_rate_limit", "tilt", "fails_at", "servo_sticks_at"};

AllocationWeights read_weights(const Table& root) {
  AllocationWeights weights;
  std::vector<std::string> names;
  for (const WeightKey& key : kWeightKeys) names.emplace_back(key.name);
  if (const auto table = root.table("weights", names)) {
    for (const WeightKey& key : kWeightKeys) weights.*key.field = table->number(key.name, weights.*key.field);
  }
  return weights;
}

SolverChoice read_solver(const Table& root) {
  SolverChoice choice;
  if (const auto table = root.table("solver", {"name", "tolerance", "max_iterations"})) {
    if (table->has("name")) choice.name = table->text("name");
    if (table->has("tolerance")) choice.tolerance = table->number("tolerance");
    if (table->has("max_iterations")) choice.max_iterations = table->integer("max_iterations");
  }
  return choice;
}

void read_interval(const Table& table, const std::string& key, double& lower, double& upper) {
  if (!table.has(key)) return;
  const std::vector<double> limits = table.numbers(key, 2);
  lower = limits[0];
  upper = limits[1];
}

Rotor read_rotor(const Table& table) {
  Rotor rotor;
  rotor.tilt = table.flag("tilt", true);
  rotor.position = table.vector3("position");
  rotor.axis = rotor.tilt ? table.vector3("axis") : table.vector3("axis", rotor.axis);
  rotor.zero = table.vector3("zero");
  rotor.spin = table.integer("spin");
  rotor.thrust = table.numbers("thrust");
  rotor.torque = table.numbers("torque");
  read_interval(table, "throttle", rotor.throttle_lower, rotor.throttle_upper);
  read_interval(table, "angle", rotor.angle_lower, rotor.angle_upper);
  rotor.angle_rate_limit = table.number("angle_rate_limit", rotor.angle_rate_limit);
  rotor.fails_at = table.number("fails_at", rotor.fails_at);
  rotor.servo_sticks_at = table.number("servo_sticks_at", rotor.servo_sticks_at);
  return rotor;
}

std::string list(const std::vector<double>& numbers) {
  return fmt::format("[{}]", fmt::join(numbers, ", "));
}
std::string list(const Eigen::Vector3d& v) {
  return fmt::format("[{}, {}, {}]", v[0], v[1], v[2]);
}

/// A line for a number with a value, nothing for one without limit.
std::string line(const std::string& key, double value) {
  return std::isfinite(value) ? fmt::format("{} = {}\n", key, value) : "";
}

}  // namespace

VehicleFile parse_vehicle(const std::string& text, const std::string& file, const std::vector<std::string>& overrides) {
  const Table root = toml_file::Document(text, file, overrides).root(kRootKeys);
  VehicleFile out;
  Vehicle& vehicle = out.vehicle;
  vehicle.name = root.text("name", std::filesystem::path(file).stem().string());
  vehicle.mass = root.number("mass");
  vehicle.inertia = root.vector3("inertia", vehicle.inertia);
  vehicle.gravity = root.number("gravity", vehicle.gravity);
  if (const auto limits = root.table("limits", {"hard"})) vehicle.hard_limits = limits->flag("hard", vehicle.hard_limits);
  vehicle.weights = read_weights(root);
  out.solver = read_solver(root);
  const std::vector<Table> rotors = root.tables("rotor", kRotorKeys);
  for (const Table& table : rotors) vehicle.rotors.push_back(read_rotor(table));
  try {
    for (const std::string& note : normalise(vehicle)) out.notes.push_back(file + ": " + note);
  } catch (const VehicleError& error) {
    const Table& table = error.rotor() < 0 ? root : rotors[static_cast<std::size_t>(error.rotor())];
    throw InputError(table.position(error.key()), error.found(), error.expected());
  }
  return out;
}

std::vector<std::string> builtin_vehicles() {
  std::vector<std::string> names;
  for (const EmbeddedFile& file : embedded_vehicles()) names.emplace_back(file.name);
  std::sort(names.begin(), names.end());
  return names;
}

std::string describe_builtin_vehicle(const std::string& name) {
  for (const EmbeddedFile& file : embedded_vehicles()) {
    if (file.name == name) return std::string(file.text.substr(2, file.text.find('\n') - 2));
  }
  return "";
}

VehicleFile load_vehicle(const std::string& name_or_path, const std::vector<std::string>& overrides) {
  for (const EmbeddedFile& file : embedded_vehicles()) {
    if (file.name == name_or_path) return parse_vehicle(std::string(file.text), name_or_path, overrides);
  }
  const bool is_path =
      name_or_path.find('/') != std::string::npos || name_or_path.ends_with(".toml") || std::filesystem::exists(name_or_path);
  if (!is_path) {
    throw std::invalid_argument(fmt::format("unknown vehicle '{}', the nearest is '{}' (expected one of {}, or a TOML file)", name_or_path,
                                            nearest_name(name_or_path, builtin_vehicles()), fmt::join(builtin_vehicles(), ", ")));
  }
  return parse_vehicle(read_file(name_or_path), name_or_path, overrides);
}

std::string to_toml(const Vehicle& vehicle) {
  std::string text = fmt::format("name = \"{}\"\nmass = {}\ninertia = {}\ngravity = {}\n", vehicle.name, vehicle.mass,
                                 list(vehicle.inertia), vehicle.gravity);
  text += fmt::format("\n[limits]\nhard = {}\n\n[weights]\n", vehicle.hard_limits);
  for (const WeightKey& key : kWeightKeys) text += line(key.name, vehicle.weights.*key.field);
  for (const Rotor& rotor : vehicle.rotors) {
    text += fmt::format("\n[[rotor]]\nposition = {}\naxis = {}\nzero = {}\nspin = {}\nthrust = {}\ntorque = {}\nthrottle = [{}, {}]\n",
                        list(rotor.position), list(rotor.axis), list(rotor.zero), rotor.spin, list(rotor.thrust), list(rotor.torque),
                        rotor.throttle_lower, rotor.throttle_upper);
    if (std::isfinite(rotor.angle_lower) && std::isfinite(rotor.angle_upper)) {
      text += fmt::format("angle = [{}, {}]\n", rotor.angle_lower, rotor.angle_upper);
    }
    text += line("angle_rate_limit", rotor.angle_rate_limit);
    if (!rotor.tilt) text += "tilt = false\n";
    text += line("fails_at", rotor.fails_at) + line("servo_sticks_at", rotor.servo_sticks_at);
  }
  return text;
}

}  // namespace tenon
