// A scene to be planned, as a TOML file: which model, its numbers, and how finely to plan. The scenes that come with tenon.
//
//     model = "cart-pole"      one of ocp_models.hpp
//     contact = "phases"       how contacts enter, where the model leaves the choice: phases, complementarity, baumgarte, law
//     [parameters]             the model's own numbers, by name; --set NAME=VALUE
//     [horizon]                duration (s), intervals, points (1 to 3, of the Radau method), tolerance (of the mesh), refinements
#pragma once

#include <string>
#include <vector>

#include "tenon/core/ocp.hpp"
#include "tenon/core/scenery.hpp"

namespace tenon {

struct OcpScene {
  Ocp ocp;
  Scenery scenery;
  int points = 3;
  double tolerance = 1e-6;  // of a step's error, relative to a state's size
  int refinements = 4;
};

/// The names of those that come with tenon, sorted, and what one is, from the comment that opens its file.
std::vector<std::string> builtin_ocp_scenes();
std::string describe_builtin_ocp_scene(const std::string& name);

/// A built-in scene, or one from a file, with overrides `key.path=value`; a key without a dot that is no key of the file is a parameter.
/// Throws InputError, with the place of what is wrong; std::invalid_argument for a name that is neither, the nearest named.
OcpScene load_ocp_scene(const std::string& name_or_path, const std::vector<std::string>& overrides = {});

}  // namespace tenon
