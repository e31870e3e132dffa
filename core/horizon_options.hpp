// How the plans of a receding horizon are solved for, and which of them are good enough to be used.
#pragma once

#include <array>

#include "tenon/core/options.hpp"

namespace tenon {

struct HorizonOptions {
  HorizonOptions() { warm.warm_start = true; }

  Options ahead;                    // of the plan that is made before anything is measured, when time does not press
  Options warm;                     // of a step that has a plan to start from; 1 to 3 iterations are a real-time iteration
  Options cold;                     // of a step that has none: the one before could not be used, or is not to be
  double delay = 0;                 // s, by which commands are known to act late: commanded is what the plan has for then
  double largest_violation = 1e-3;  // of a plan's rows and bounds, in the program's units: beyond it the plan is not used

  std::array<Options*, 3> all() { return {&ahead, &warm, &cold}; }
};

}  // namespace tenon
