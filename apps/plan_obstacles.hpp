// Why there is no plan: which rows cannot be met, in which stage, and when that is; and which bounds hold them back.
//
// Where a solve ends infeasible, sum_j |violation_j| cannot be made smaller: its gradient J' sign(violation) is 0 but for the variables
// that a bound holds. Those with the largest entries are what another bound would have to give. (core/conflict.hpp finds an irreducible
// set, but gives up on as many rows as a plan has.)
#pragma once

#include <string>
#include <vector>

#include "tenon/core/conflict.hpp"
#include "tenon/mpc/planner.hpp"

namespace tenon {

struct Obstacle {
  Limit limit;
  int stage = 0;
  double t = 0;  // s
};

struct Obstacles {
  std::vector<Obstacle> violated;  // worst first
  std::vector<Obstacle> holding;   // bounds that the violation pushes against, hardest first

  /// One line: the worst with its place and what holds it back, or how the solve ended.
  std::string text(Status status) const;
};

/// At the end of a solve that failed: at most 20 of each.
Obstacles obstacles_of(const PlannerOutcome& outcome);

}  // namespace tenon
