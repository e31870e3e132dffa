#include "tenon/apps/scene_verbs.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <stdexcept>
#include <vector>

#include "tenon/problems/contact/scene_file.hpp"
#include "tenon/problems/delta/scene_file.hpp"
#include "tenon/problems/optimal_control/ocp_scene.hpp"
#include "tenon/problems/tasks.hpp"

namespace tenon {

namespace {

struct SceneKind {
  std::function<std::vector<std::string>()> names;
  std::vector<std::string> verbs;
};

const std::vector<SceneKind>& scene_kinds() {
  static const std::vector<SceneKind> kinds{{&contact::builtin_scenes, {"simulate"}},
                                            {&delta::builtin_scenes, {"simulate"}},
                                            {&builtin_tasks, {"mpc", "plan", "estimate", "sweep"}},
                                            {&builtin_ocp_scenes, {"plan", "solve", "compare"}}};
  return kinds;
}

}  // namespace

void check_scene_is_for(const std::string& verb, const std::string& scene) {
  std::vector<std::string> others;
  for (const SceneKind& kind : scene_kinds()) {
    if (std::ranges::count(kind.names(), scene) == 0) continue;
    if (std::ranges::count(kind.verbs, verb) > 0) return;
    others.insert(others.end(), kind.verbs.begin(), kind.verbs.end());
  }
  if (!others.empty()) throw std::invalid_argument(fmt::format("{}: not a scene for {} (it is for {})", scene, verb, fmt::join(others, ", ")));
}

}  // namespace tenon
