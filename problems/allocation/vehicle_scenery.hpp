// A vehicle's picture for its records: a frame, arms that turn with the columns a1..aN, thrust arrows mu(u) n(a) of the columns u1..uN, and
// their sum.
#pragma once

#include "tenon/core/scenery.hpp"
#include "tenon/problems/allocation/vehicle.hpp"

namespace tenon {

/// In body axes; who has the columns of a pose puts them into the body "frame", the first. Inputs are plotted with their limits.
Scenery vehicle_scenery(const Vehicle& vehicle);

}  // namespace tenon
