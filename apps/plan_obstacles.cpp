#include "tenon/apps/plan_obstacles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tenon/core/first_order.hpp"

namespace tenon {

namespace {

constexpr double kViolated = 1e-6, kAtBound = 1e-5;
constexpr double kHolding = 1e-3;  // of the hardest
constexpr std::size_t kMost = 20;

std::string place_text(const Obstacle& o) {
  return fmt::format("in stage {}, at t = {:.6g} s: {:.6g}, limits [{:.6g}, {:.6g}]", o.stage, o.t, o.limit.value, o.limit.lower,
                     o.limit.upper);
}

class Examination {
 public:
  explicit Examination(const PlannerOutcome& outcome)
      : program_(*outcome.program),
        x_(outcome.point.x),
        here_(program_, x_),
        bounds_(program_.num_variables(), program_.num_constraints()) {
    program_.bounds(bounds_);
  }

  Obstacles run() const {
    Obstacles out;
    Vector pull = Vector::Zero(program_.num_constraints());
    for (int j = 0; j < program_.num_constraints(); ++j) {
      const double value = here_.constraints[j], below = bounds_.c_lower[j] - value, above = value - bounds_.c_upper[j];
      const double violation = std::max(below, above);
      if (!(violation > kViolated)) continue;
      pull[j] = above > 0 ? 1 : -1;
      const Limit limit{.name = program_.constraint_name(j),
                        .value = value,
                        .lower = bounds_.c_lower[j],
                        .upper = bounds_.c_upper[j],
                        .violation = violation};
      out.violated.push_back(placed(limit, program_.place_of_row(j)));
    }
    sort(out.violated, [](const Obstacle& o) { return o.limit.violation; });
    if (out.violated.empty()) return out;
    const Vector gradient = here_.jacobian.transpose() * pull;
    for (int i = 0; i < program_.num_variables(); ++i) {
      const double lower = bounds_.x_lower[i], upper = bounds_.x_upper[i], near = kAtBound * (1 + std::abs(x_[i]));
      const bool is_held = (gradient[i] > 0 && x_[i] - lower <= near) || (gradient[i] < 0 && upper - x_[i] <= near);
      if (!is_held) continue;
      const Limit limit{
          .name = program_.variable_name(i), .is_bound = true, .value = x_[i], .lower = lower, .upper = upper, .multiplier = -gradient[i]};
      out.holding.push_back(placed(limit, program_.place_of_variable(i)));
    }
    const auto push = [](const Obstacle& o) { return std::abs(o.limit.multiplier); };
    sort(out.holding, push);
    std::erase_if(out.holding, [&, hardest = out.holding.empty() ? 0 : push(out.holding.front())](const Obstacle& o) {
      return push(o) < kHolding * hardest;
    });
    return out;
  }

 private:
  Obstacle placed(const Limit& limit, const Collocation::Place& place) const { return {limit, place.stage, program_.time_of(place, x_)}; }

  template <class Measure>
  static void sort(std::vector<Obstacle>& list, Measure&& measure) {
    std::stable_sort(list.begin(), list.end(), [&](const Obstacle& a, const Obstacle& b) { return measure(a) > measure(b); });
    if (list.size() > kMost) list.resize(kMost);
  }

  const Collocation& program_;
  const Vector& x_;
  FirstOrder here_;
  Bounds bounds_;
};

}  // namespace

Obstacles obstacles_of(const PlannerOutcome& outcome) {
  return Examination(outcome).run();
}

std::string Obstacles::text(Status status) const {
  if (violated.empty()) return fmt::format("no plan: {}", to_string(status));
  std::string text = fmt::format("no plan: {} cannot be met {}", violated.front().limit.name, place_text(violated.front()));
  if (!holding.empty()) text += fmt::format("; held back by the bounds of {} {}", holding.front().limit.name, place_text(holding.front()));
  return text;
}

}  // namespace tenon
