// The picture of a peg and its hole: columns of PegPlant's record, of the commands and of the plan.
#pragma once

#include "tenon/core/scenery.hpp"
#include "tenon/problems/peg_in_hole/geometry.hpp"

namespace tenon::peg {

Scenery scenery_of(const Geometry& geometry);

}  // namespace tenon::peg
