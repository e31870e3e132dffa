#include "tenon/apps/simulation.hpp"

#include "tenon/problems/contact/contact_dae.hpp"

namespace tenon {

namespace {

template <int D>
std::unique_ptr<Dae> make_dae(contact::Scene<D> scene) {
  return std::make_unique<contact::ContactDae<D>>(std::move(scene));
}

}  // namespace

Simulation open_simulation(const std::string& name_or_path, const std::vector<std::string>& overrides) {
  contact::SceneFile file = contact::load_scene(name_or_path, overrides);
  Simulation out;
  out.settings = file.simulation;
  out.scenery = std::move(file.scenery);
  std::visit(
      [&](auto& scene) {
        for (const auto& c : scene.constraints) {
          if (!c.is_joint() && c.is_two_scale && c.restitution > 0) out.collisions[c.name] = contact::law_of(c.restitution, c.contact_time);
        }
        out.dae = make_dae(std::move(scene));
      },
      file.scene);
  return out;
}

}  // namespace tenon
