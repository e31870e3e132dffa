// The picture of a peg and its hole: columns of PegPlant's record, of the commands, of the estimate and of the plan.
#pragma once

#include "tenon/core/scenery.hpp"
#include "tenon/problems/peg_in_hole/assembly_program.hpp"

namespace tenon::peg {

/// `height_is_known`: nothing is to be seen of an estimate of the hole's height.
Scenery scenery_of(const AssemblyProblem& problem, bool height_is_known);

}  // namespace tenon::peg
