// Which verbs a built-in scene is for: what one verb knows as a scene, another may not take.
#pragma once

#include <string>

namespace tenon {

/// Throws std::invalid_argument where a scene that comes with tenon is for other verbs, naming them; leaves all other names to the verb.
void check_scene_is_for(const std::string& verb, const std::string& scene);

}  // namespace tenon
