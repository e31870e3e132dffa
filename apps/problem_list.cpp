#include "tenon/apps/problem_list.hpp"

#include <algorithm>

#include "tenon/mpc/collocation.hpp"
#include "tenon/problems/optimal_control/ocp_scene.hpp"

namespace tenon {

namespace {

std::vector<CatalogueEntry> collect() {
  std::vector<CatalogueEntry> all = catalogue();
  for (const std::string& scene : builtin_ocp_scenes()) {
    const bool is_taken = std::ranges::count(catalogue(), scene, &CatalogueEntry::name) > 0;
    all.push_back({is_taken ? scene + "/collocation" : scene, describe_builtin_ocp_scene(scene), std::nullopt, [scene] {
                     const OcpScene loaded = load_ocp_scene(scene);
                     return std::make_unique<Collocation>(loaded.ocp, loaded.points);
                   }});
  }
  std::ranges::sort(all, {}, &CatalogueEntry::name);
  return all;
}

}  // namespace

const std::vector<CatalogueEntry>& problem_list() {
  static const std::vector<CatalogueEntry> all = collect();
  return all;
}

}  // namespace tenon
