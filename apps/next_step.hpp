// What to do after a solve that did not end well: one line for the end of a summary.
#pragma once

#include <string_view>

#include "tenon/core/status.hpp"

namespace tenon {

/// Empty where there is nothing to do.
constexpr std::string_view next_step(Status status) {
  switch (status) {
    case Status::solved: return "";
    case Status::acceptable: return "good to a hundredth of what was asked; --verbose shows where progress ended";
    case Status::infeasible: return "loosen a row that is violated, or start elsewhere: another start may find a point that meets all";
    case Status::unbounded: return "bound the variables that run away, or look for a sign that is wrong";
    case Status::iteration_limit: return "raise --max-iterations; --report FILE.html shows whether it was still on its way";
    case Status::time_limit: return "raise --time-limit; --report FILE.html shows whether it was still on its way";
    case Status::stopped: return "";
    case Status::invalid_start: return "start where every function has a value";
    case Status::numerical_failure: return "look at the derivatives with `tenon check`, and at the scales of variables and rows";
  }
  return "";
}

}  // namespace tenon
