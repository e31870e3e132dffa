#include "tenon/apps/simulation.hpp"

#include <algorithm>

#include "tenon/core/nearest_name.hpp"
#include "tenon/problems/contact/contact_dae.hpp"
#include "tenon/problems/delta/scene_dae.hpp"
#include "tenon/problems/delta/scene_file.hpp"
#include "tenon/problems/delta/scene_scenery.hpp"

namespace tenon {

namespace {

template <int D>
std::unique_ptr<Dae> make_dae(contact::Scene<D> scene) {
  return std::make_unique<contact::ContactDae<D>>(std::move(scene));
}

Simulation open_contact(const std::string& name_or_path, const std::vector<std::string>& overrides) {
  contact::SceneFile file = contact::load_scene(name_or_path, overrides);
  Simulation out;
  out.settings = file.simulation;
  out.scenery = std::move(file.scenery);
  std::visit(
      [&](auto& scene) {
        for (const auto& c : scene.constraints) {
          if (!c.is_joint() && c.is_two_scale && c.restitution > 0) out.collisions[c.name] = c.collision_law();
        }
        out.dae = make_dae(std::move(scene));
      },
      file.scene);
  return out;
}

Simulation open_delta(const std::string& name_or_path, const std::vector<std::string>& overrides) {
  delta::Scene scene = delta::load_scene(name_or_path, overrides);
  Simulation out;
  out.settings.duration = scene.duration;
  out.settings.output_step = scene.output_step;
  out.settings.rtol = scene.rtol;
  out.settings.atol = 1e-2 * scene.rtol;
  if (scene.control == delta::ControlMode::sampled) out.settings.integrator = "dopri5";  // its clock is what keeps steps short
  out.scenery = delta::scene_scenery(scene);
  out.dae = std::make_unique<delta::SceneDae>(std::move(scene));
  return out;
}

/// Whether a name that nobody has is nearer to a delta robot's scene.
bool sounds_like_delta(const std::string& name) {
  std::vector<std::string> names = contact::builtin_scenes();
  const std::vector<std::string> delta_names = delta::builtin_scenes();
  names.insert(names.end(), delta_names.begin(), delta_names.end());
  return std::ranges::count(delta_names, nearest_name(name, names)) > 0;
}

}  // namespace

Simulation open_simulation(const std::string& name_or_path, const std::vector<std::string>& overrides) {
  const bool is_word = name_or_path.find_first_of("/.") == std::string::npos;
  const bool is_delta = delta::has_delta_robot(name_or_path) || (is_word && sounds_like_delta(name_or_path));
  return is_delta ? open_delta(name_or_path, overrides) : open_contact(name_or_path, overrides);
}

}  // namespace tenon
