// A scene with a delta robot as a TOML file, and those that come with tenon.
//
//     [robot]       model = a built-in robot or a file, and any key of its file to override
//     [start]       position, velocity of the wrist (m, m/s); without it the run starts on the reference, moving as that does
//     [reference]   kind = "hold" | "circle" | "knots", centre, radius, frequency; [[reference.knot]] t, position
//     [controller]  mode = "none" | "continuous" | "sampled", form = "linearising" | "impedance", pole or kp, kd, ki; feed_forward,
//                   coriolis, damping (as coriolis, unless said), inertia = "exact" | "projected-left", stiffness, impedance_damping,
//                   integral_limit, rate (Hz), delay (ticks), encoder_bits, filter (Hz), payload, tactile_gain, tactile_limit,
//                   tactile_axis; of the gimbals tool_pole, or tool_stiffness and tool_damping under impedance
//     [[contact]]   name, normal, offset, stiffness, damping, finger, sensor = "left" | "right"
//     [gripper]     from, to, begin, end          [object] mass, position, stiffness, damping          [tool] angle, reference
//     [push]        constant, amplitude, from, to, duration, on = "wrist" | "object"
//     [simulation]  duration, rtol, output_step
//     [parameters]  keys of [reference] and [controller] that are meant to be varied: they stand before those
#pragma once

#include <string>
#include <vector>

#include "tenon/problems/delta/scene.hpp"

namespace tenon::delta {

/// The names of the scenes that come with tenon, sorted.
std::vector<std::string> builtin_scenes();
/// What a built-in scene is, from the comment that opens its file.
std::string describe_builtin_scene(const std::string& name);
/// Whether this scene has a delta robot: one of those names, or a file with a [robot].
bool has_delta_robot(const std::string& name_or_path);

/// A built-in scene, or one from a file, with overrides `key.path=value`, or NAME=VALUE for one of its [parameters]. Throws InputError,
/// with the place of what is wrong; std::invalid_argument for a name that is neither, the nearest named.
Scene load_scene(const std::string& name_or_path, const std::vector<std::string>& overrides = {});

/// The same from text; `file` is the name used in messages.
Scene parse_scene(const std::string& text, const std::string& file, const std::vector<std::string>& overrides = {});

}  // namespace tenon::delta
