// A scene as a TOML file, and the scenes that come with tenon.
//
//     [parameters]  name = value                     set by --set NAME=VALUE; every number below may be text: an expression in these names
//     [simulation]  space, gravity, duration, output_step, rtol, atol, integrator, impact_law, audit,
//                   stabilisation = "baumgarte" | "gear-gupta-leimkuhler"               of joints
//     [[body]]      name, kind = "line" | "point" | "rigid", mass, inertia, position, angle (planar) or quaternion, velocity, omega
//     [[shape]]     name, body = "world", type = "point" | "disc" | "half-plane" | "segment" | "capsule" | "polygon" | "box" | "hole"
//                   (in space: "point", "sphere", "half-space", "capsule", "box"),
//                   at, radius, point, normal, from, to, vertices, size, angle           in the body's own axes
//                   of a hole: width, depth, chamfer, rim (how wide the plate is around it), at (middle of its mouth), angle
//     [[joint]]     name, type = "revolute" | "distance" | "rope" | "slide" | "angle" | "weld" | "guide", between, at, from, to, length,
//     axis, lock, pole or stabilisation,
//                   amplitude, frequency, phase, and a rope's contact keys                places in world axes, at the start
//     [[contact]]   name, between = [shape or body, shape or body], restitution and contact_time or collision = [beta0, beta1] or
//                   [beta0, beta1, beta3], alpha = [a0, a1, a3], one_law, friction, friction_speed, rest_speed, rest_acceleration
//     [[force]]     name, type = "spring" | "torsion" | "constant" | "sinusoid" | "expression" | "drag", between or on, from, to,
//     stiffness, damping, rest,
//                   force, torque, frequency, phase, expression
//
// Any of the tables may have `count`, and is then taken count times with i = 1, 2, ...; {expressions} in its texts are replaced by their
// integer.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "tenon/core/input_error.hpp"
#include "tenon/core/scenery.hpp"
#include "tenon/problems/contact/scene.hpp"

namespace tenon::contact {

struct SimulationSettings {
  double duration = 1;        // s
  double output_step = 0.01;  // s
  double rtol = 1e-8, atol = 1e-10;
  std::string integrator = "dop853";
};

struct SceneFile {
  std::variant<Scene<2>, Scene<3>> scene;
  SimulationSettings simulation;
  Scenery scenery;  // its picture
};

/// The names of the scenes that come with tenon, sorted.
std::vector<std::string> builtin_scenes();
/// What a built-in scene is, from the comment that opens its file.
std::string describe_builtin_scene(const std::string& name);

/// A built-in scene, or one from a file, with overrides `key.path=value`; a key without a dot is one of the scene's parameters. Throws
/// InputError, with the place of what is wrong; std::invalid_argument for a name that is neither, the nearest named.
SceneFile load_scene(const std::string& name_or_path, const std::vector<std::string>& overrides = {});
/// The same from text; `file` is the name used in messages.
SceneFile parse_scene(const std::string& text, const std::string& file, const std::vector<std::string>& overrides = {});

}  // namespace tenon::contact
