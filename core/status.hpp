// Why a solve ended. What the point is then worth is another question: see kkt_residual.hpp.
#pragma once

#include <string_view>

namespace tenon {

enum class Status {
  solved,             // every scaled residual <= tolerance
  acceptable,         // no further progress, every scaled residual <= kAcceptableFactor * tolerance
  infeasible,         // a stationary point of the constraint violation, which is not 0
  unbounded,          // the objective falls without limit along feasible iterates
  iteration_limit,    // Options::max_iterations reached
  time_limit,         // Options::time_limit reached
  stopped,            // Options::on_iteration asked for it
  invalid_start,      // a function or derivative is not finite at the starting point
  numerical_failure,  // no step could be computed or accepted
};

/// How much coarser than the tolerance an acceptable residual may be. 100 is also Ipopt's: tol 1e-8, acceptable_tol 1e-6.
inline constexpr double kAcceptableFactor = 100;

/// The name of a status as it stands in every file.
constexpr std::string_view to_string(Status status) {
  switch (status) {
    case Status::solved: return "solved";
    case Status::acceptable: return "acceptable";
    case Status::infeasible: return "infeasible";
    case Status::unbounded: return "unbounded";
    case Status::iteration_limit: return "iteration_limit";
    case Status::time_limit: return "time_limit";
    case Status::stopped: return "stopped";
    case Status::invalid_start: return "invalid_start";
    case Status::numerical_failure: return "numerical_failure";
  }
  return "unknown";
}

/// Solved, or as near as the arithmetic allows.
constexpr bool succeeded(Status status) { return status == Status::solved || status == Status::acceptable; }

}  // namespace tenon
