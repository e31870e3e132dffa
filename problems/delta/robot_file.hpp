// A delta robot as a TOML file, and the robots that come with tenon.
//
//     name, base_radius, proximal_length, distal_length, wrist_radius, proximal_com, distal_com, proximal_mass, distal_mass, wrist_mass,
//     payload, proximal_inertia, distal_inertia, damping = [q1, q2, q3], gravity, torque_limit, stabilisation,
//     gimbal_inertia = [yaw, pitch, roll], gimbal_torque_limit                named as the fields of Robot; a limit left out is no limit
#pragma once

#include <string>
#include <vector>

#include "tenon/problems/delta/robot.hpp"

namespace tenon::delta {

/// The names of the robots that come with tenon, sorted.
std::vector<std::string> builtin_robots();
/// What a built-in robot is, from the comment that opens its file.
std::string describe_builtin_robot(const std::string& name);

/// A built-in robot, or one from a file, with overrides `key=value`. Throws InputError, with the place of what is wrong;
/// std::invalid_argument for a name that is neither, the nearest named.
Robot load_robot(const std::string& name_or_path, const std::vector<std::string>& overrides = {});

/// The same from text; `file` is the name used in messages.
Robot parse_robot(const std::string& text, const std::string& file, const std::vector<std::string>& overrides = {});

/// A file that reads back as the same robot, bit for bit.
std::string to_toml(const Robot& robot);

}  // namespace tenon::delta
