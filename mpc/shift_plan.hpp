// A plan one interval later: what the next solve starts from.
//
//     w_0 w_1 ... w_{N-1} w_N    ->    w_1 w_2 ... (x_N, u_{N-1}) w_N        and the rows' multipliers likewise
//
// The new last interval repeats the input of the one before it, and starts in the old end state, which is repeated too.
#pragma once

#include "tenon/core/point.hpp"
#include "tenon/core/stages.hpp"

namespace tenon {

/// Stages 0 to N-1 are laid out alike, and the last one's variables are the first of theirs (HorizonProgram). Globals stay. Allocates nothing.
void shift_plan(const Stages& stages, Point& plan);

}  // namespace tenon
