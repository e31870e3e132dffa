// A mission as a TOML file, and those that come with tenon.
//
//     [vehicle]           model = a built-in vehicle or a file, mass, inertia (to override)
//     [reference]         kind = "legs" | "tumble" | "figure-eight", position, turn_deg (at the start)
//                         rate_deg, ramp of a tumble; period, ramp, size, tilt_deg of a figure-eight
//     [[reference.leg]]   duration (s; 0 for a step), position (at its end; left out: where it was), turn_deg (rotation vector, world axes)
//     [controller]        rate (Hz), force = [P, I, D], torque = [P, I, D], force_limit, torque_limit (of the integrals), observer (rad/s),
//                         disturbance (share subtracted, 0 to 1), mass and actuator_lag (as it takes them to be), lag_compensation
//     [sensors]           position_noise (m), attitude_noise_deg, delay (ticks), drop_out (probability)
//     [actuators]         rotor_lag, servo_lag (s)
//     [wind]              steady (N), deviation (N), correlation (s)
//     [[failure]]         kind = "rotor" | "servo", rotor (from 1), t, detection (s; left out: 0.1)
//     [payload]           mass
//     [simulation]        duration (s; left out: that of the legs), rtol, output_ticks, lost (m)
#pragma once

#include <string>
#include <vector>

#include "tenon/problems/flight/mission.hpp"

namespace tenon::flight {

/// The names of the missions that come with tenon, sorted.
std::vector<std::string> builtin_missions();
/// What a built-in mission is, from the comment that opens its file.
std::string describe_builtin_mission(const std::string& name);

/// A built-in mission, or one from a file, with overrides `key.path=value`. Throws InputError, with the place of what is wrong;
/// std::invalid_argument for a name that is neither, the nearest named.
Mission load_mission(const std::string& name_or_path, const std::vector<std::string>& overrides = {});

/// The same from text; `file` is the name used in messages.
Mission parse_mission(const std::string& text, const std::string& file, const std::vector<std::string>& overrides = {});

}  // namespace tenon::flight
