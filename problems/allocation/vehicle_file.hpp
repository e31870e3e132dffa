// A vehicle as a TOML file, and the vehicles that come with tenon.
//
//     name, mass, inertia = [x, y, z], gravity
//     [limits] hard = true                      throttle, angle and angle-rate limits as bounds
//     [weights] ...                             keys named as the fields of AllocationWeights
//     [solver] name, tolerance, max_iterations
//     [[rotor]] position, axis, zero, spin, thrust, torque, throttle = [lo, hi], angle = [lo, hi], angle_rate_limit, tilt, fails_at,
//               servo_sticks_at                 axis is not needed where tilt = false; a limit left out is no limit
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tenon/problems/allocation/vehicle.hpp"

namespace tenon {

/// The [solver] table: what the file asks for, where it does.
struct SolverChoice {
  std::optional<std::string> name;
  std::optional<double> tolerance;
  std::optional<int> max_iterations;
};

struct VehicleFile {
  Vehicle vehicle;  // normalised
  SolverChoice solver;
  std::vector<std::string> notes;  // one line each: what was brought to unit length
};

/// The names of the vehicles that come with tenon, sorted.
std::vector<std::string> builtin_vehicles();
/// What a built-in vehicle is, from the comment that opens its file.
std::string describe_builtin_vehicle(const std::string& name);

/// A built-in vehicle, or one from a file, with overrides `key.path=value`. Throws InputError, with the place of what is wrong;
/// std::invalid_argument for a name that is neither, the nearest named.
VehicleFile load_vehicle(const std::string& name_or_path, const std::vector<std::string>& overrides = {});

/// The same from text; `file` is the name used in messages.
VehicleFile parse_vehicle(const std::string& text, const std::string& file, const std::vector<std::string>& overrides = {});

/// A file that reads back as the same vehicle, bit for bit.
std::string to_toml(const Vehicle& vehicle);

}  // namespace tenon
