// The picture of a delta robot's scene: base, arms, wrist, the wall it may touch, forces, the reference it follows.
#pragma once

#include "tenon/core/scenery.hpp"
#include "tenon/problems/delta/scene.hpp"

namespace tenon::delta {

/// Bound to the columns of the scene's record.
Scenery scene_scenery(const Scene& scene);

}  // namespace tenon::delta
