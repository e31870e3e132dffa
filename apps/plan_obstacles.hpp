// Why there is no plan: which rows and bounds cannot be met, in which stage, and when that is.
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

/// Of an infeasible end, what stands against one another, else what is violated; worst first. Empty where everything is met.
std::vector<Obstacle> obstacles_of(const PlannerOutcome& outcome);

/// One line: the worst of them with its place, or how the solve ended.
std::string say_no_plan(const PlannerOutcome& outcome, const std::vector<Obstacle>& obstacles);

}  // namespace tenon
