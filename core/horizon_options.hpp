// How the plans of a receding horizon are solved for, and which of them are good enough to be used.
#pragma once

#include "tenon/core/options.hpp"

namespace tenon {

struct HorizonOptions {
  HorizonOptions() { warm.warm_start = true; }

  Options warm;                     // of a step that has a plan to start from; 1 to 3 iterations are a real-time iteration
  Options cold;                     // of the first step, and of the one after a plan that could not be used
  double largest_violation = 1e-3;  // of a plan's rows and bounds, in the program's units: beyond it the plan is not used
};

}  // namespace tenon
