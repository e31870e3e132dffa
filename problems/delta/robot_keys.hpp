// The numbers of a robot by the keys of its TOML: one table for reading, checking and writing.
#pragma once

#include "tenon/problems/delta/robot.hpp"

namespace tenon::delta {

enum class Allowed { positive, not_negative };

struct RobotKey {
  const char* name;
  double Robot::*field;
  Allowed allowed;
  bool required;
  const char* unit;
};

inline constexpr RobotKey kRobotKeys[] = {
    {"base_radius", &Robot::base_radius, Allowed::not_negative, true, "m"},
    {"proximal_length", &Robot::proximal_length, Allowed::positive, true, "m"},
    {"distal_length", &Robot::distal_length, Allowed::positive, true, "m"},
    {"wrist_radius", &Robot::wrist_radius, Allowed::not_negative, true, "m"},
    {"proximal_com", &Robot::proximal_com, Allowed::not_negative, true, "m"},
    {"distal_com", &Robot::distal_com, Allowed::not_negative, true, "m"},
    {"proximal_mass", &Robot::proximal_mass, Allowed::positive, true, "kg"},
    {"distal_mass", &Robot::distal_mass, Allowed::positive, true, "kg"},
    {"wrist_mass", &Robot::wrist_mass, Allowed::not_negative, true, "kg"},
    {"payload", &Robot::payload, Allowed::not_negative, false, "kg"},
    {"proximal_inertia", &Robot::proximal_inertia, Allowed::not_negative, true, "kg m^2"},
    {"distal_inertia", &Robot::distal_inertia, Allowed::not_negative, true, "kg m^2"},
    {"gravity", &Robot::gravity, Allowed::not_negative, false, "m/s^2"},
    {"torque_limit", &Robot::torque_limit, Allowed::positive, false, "N m"},
    {"stabilisation", &Robot::stabilisation, Allowed::not_negative, false, "1/s"},
    {"gimbal_torque_limit", &Robot::gimbal_torque_limit, Allowed::positive, false, "N m"},
};

struct RobotVectorKey {
  const char* name;
  Eigen::Vector3d Robot::*field;
  const char* unit;
};

inline constexpr RobotVectorKey kRobotVectorKeys[] = {
    {"damping", &Robot::damping, "N m s"},
    {"gimbal_inertia", &Robot::gimbal_inertia, "kg m^2"},
};

}  // namespace tenon::delta
