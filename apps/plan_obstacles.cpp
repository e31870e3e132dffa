#include "tenon/apps/plan_obstacles.hpp"

#include <fmt/format.h>

namespace tenon {

namespace {

constexpr double kViolated = 1e-6;

Collocation::Place place_of(const Collocation& program, const Limit& limit) {
  const int count = limit.is_bound ? program.num_variables() : program.num_constraints();
  for (int i = 0; i < count; ++i) {
    if ((limit.is_bound ? program.variable_name(i) : program.constraint_name(i)) == limit.name)
      return limit.is_bound ? program.place_of_variable(i) : program.place_of_row(i);
  }
  return {};
}

}  // namespace

std::vector<Obstacle> obstacles_of(const PlannerOutcome& outcome) {
  const Collocation& program = *outcome.program;
  std::vector<Limit> limits;
  if (outcome.result.status == Status::infeasible) limits = conflict(program, outcome.point.x);
  if (limits.empty()) limits = violated_limits(program, outcome.point.x, kViolated);
  std::vector<Obstacle> obstacles;
  for (const Limit& limit : limits) {
    const Collocation::Place place = place_of(program, limit);
    obstacles.push_back({limit, place.stage, program.time_of(place, outcome.point.x)});
  }
  return obstacles;
}

std::string say_no_plan(const PlannerOutcome& outcome, const std::vector<Obstacle>& obstacles) {
  if (obstacles.empty()) return fmt::format("no plan: {}", to_string(outcome.result.status));
  const Obstacle& worst = obstacles.front();
  return fmt::format("no plan: {}{} cannot be met in stage {}, at t = {:.6g} s: {:.6g}, not in [{:.6g}, {:.6g}]",
                     worst.limit.is_bound ? "the bounds of " : "", worst.limit.name, worst.stage, worst.t, worst.limit.value, worst.limit.lower,
                     worst.limit.upper);
}

}  // namespace tenon
