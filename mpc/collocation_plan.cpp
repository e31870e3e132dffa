// From the variables of a collocated problem to its plan and back; where and when a row or variable stands.
#include <algorithm>
#include <utility>

#include "tenon/mpc/collocation.hpp"

namespace tenon {

Plan Collocation::plan(ConstVectorRef x) const {
  const int nx = ocp_.dae->num_states(), ny = ocp_.dae->num_algebraics(), s = method_.points;
  std::vector<PlanInterval> intervals;
  std::vector<DaeMode> modes;
  for (const OcpPhase& phase : ocp_.phases) modes.push_back(phase.mode);
  double start = 0;
  for (const StagePlace& stage : stages_) {
    const double duration = this->duration(stage.phase, x);
    if (is_end(stage)) {
      start += duration;
      continue;
    }
    const CollocationStage& functions = this->functions(stage);
    PlanInterval interval{stage.phase,
                          start + stage.begin * duration,
                          stage.fraction * duration,
                          Eigen::MatrixXd(nx, s + 1),
                          Eigen::MatrixXd(ny, s),
                          x.segment(stage.first_variable + functions.u_at(), ocp_.dae->num_inputs())};
    for (int i = 0; i <= s; ++i) {
      interval.x.col(i) = x.segment(stage.first_variable + functions.x_at(i), nx);
      if (i > 0) interval.y.col(i - 1) = x.segment(stage.first_variable + functions.y_at(i), ny);
    }
    intervals.push_back(std::move(interval));
  }
  return Plan(method_.abscissae, std::move(intervals), std::move(modes));
}

void Collocation::point_of(const Plan& plan, VectorRef x) const {
  const int nx = ocp_.dae->num_states();
  std::size_t k = 0;  // interval of the plan
  double phase_start = 0, phase_end = 0;
  for (const StagePlace& stage : stages_) {
    if (stage.interval == 0) {
      while (plan.intervals()[k].phase != stage.phase) ++k;
      phase_start = phase_end = plan.intervals()[k].t;
      for (const PlanInterval& interval : plan.intervals()) {
        if (interval.phase == stage.phase) phase_end = interval.t + interval.length;
      }
      if (duration_variable(stage.phase) >= 0) x[duration_variable(stage.phase)] = phase_end - phase_start;
    }
    const CollocationStage& functions = this->functions(stage);
    const auto at = [&](double fraction) {
      const double t = phase_start + fraction * (phase_end - phase_start);
      const auto is_last = [&] { return k + 1 == plan.intervals().size() || plan.intervals()[k + 1].phase != stage.phase; };
      while (!is_last() && plan.intervals()[k + 1].t < t) ++k;
      return plan.at(k, std::clamp((t - plan.intervals()[k].t) / plan.intervals()[k].length, 0.0, 1.0));
    };
    if (is_end(stage)) {
      x.segment(stage.first_variable, nx) = at(1).x;
      continue;
    }
    x.segment(stage.first_variable, nx) = at(stage.begin).x;
    for (int i = 1; i <= functions.points(); ++i) {
      const DaeState state = at(stage.begin + method_.abscissae[i] * stage.fraction);
      if (i < functions.points()) x.segment(stage.first_variable + functions.x_at(i), nx) = state.x;
      x.segment(stage.first_variable + functions.y_at(i), state.y.size()) = state.y;
      if (i == 1) x.segment(stage.first_variable + functions.u_at(), state.u.size()) = state.u;
    }
  }
}

Collocation::Place Collocation::place_of_row(int j) const {
  const std::size_t k = stage_of_row(j);
  const StagePlace& stage = stages_[k];
  return {static_cast<int>(k), stage.phase,
          stage.begin + method_.abscissae[functions(stage).point_of_row(j - stage.first_row)] * stage.fraction};
}

Collocation::Place Collocation::place_of_variable(int i) const {
  if (i >= first_global_) return {.phase = -1};
  const std::size_t k = stage_of_variable(i);
  const StagePlace& stage = stages_[k];
  return {static_cast<int>(k), stage.phase,
          stage.begin + method_.abscissae[functions(stage).point_of_variable(i - stage.first_variable)] * stage.fraction};
}

double Collocation::time_of(const Place& place, ConstVectorRef x) const {
  double t = 0;
  for (int p = 0; p < place.phase; ++p) t += duration(p, x);
  return place.phase < 0 ? 0 : t + place.fraction * duration(place.phase, x);
}

}  // namespace tenon
