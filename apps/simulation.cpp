#include "tenon/apps/simulation.hpp"

#include "tenon/problems/contact/contact_dae.hpp"

namespace tenon {

Simulation open_simulation(const std::string& name_or_path, const std::vector<std::string>& overrides) {
  contact::SceneFile file = contact::load_scene(name_or_path, overrides);
  Simulation out;
  out.settings = file.simulation;
  if (auto* planar = std::get_if<contact::Scene<2>>(&file.scene))
    out.dae = std::make_unique<contact::ContactDae<2>>(std::move(*planar));
  else
    out.dae = std::make_unique<contact::ContactDae<3>>(std::move(std::get<contact::Scene<3>>(file.scene)));
  return out;
}

}  // namespace tenon
