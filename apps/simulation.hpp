// A scene opened by name or file: its equations, and how long and how finely to integrate them.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tenon/core/dae.hpp"
#include "tenon/problems/contact/scene_file.hpp"

namespace tenon {

struct Simulation {
  std::unique_ptr<Dae> dae;
  contact::SimulationSettings settings;
  std::map<std::string, contact::Law> collisions;  // the law of each two-scale contact's fast phase, by the contact's name
  Scenery scenery;  // its picture, for the record
};

/// A delta robot's scene or one of bodies in contact. Throws as their load_scene do, and where the wrist starts at a singularity.
Simulation open_simulation(const std::string& name_or_path, const std::vector<std::string>& overrides = {});

}  // namespace tenon
