// The picture of a flight: the vehicle with its thrusts, the reference as a ghost, the wind; errors, throttles and arm rates with limits.
#pragma once

#include "tenon/core/scenery.hpp"
#include "tenon/problems/flight/mission.hpp"

namespace tenon::flight {

/// Bound to the columns of the mission's record.
Scenery flight_scenery(const Mission& mission);

}  // namespace tenon::flight
