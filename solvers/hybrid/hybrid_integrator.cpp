#include "tenon/solvers/hybrid/hybrid_integrator.hpp"

#include <algorithm>
#include <cmath>

#include "tenon/solvers/hybrid/exact_flow.hpp"

namespace tenon {

namespace {

constexpr std::size_t kMostSuspects = 4;

}  // namespace

HybridIntegrator::HybridIntegrator(const Dae& dae, const IntegratorOptions& options, std::unique_ptr<Flow> flow)
    : dae_(dae),
      options_(options),
      flow_(std::move(flow)),
      exact_(make_exact_flow(dae)),
      current_(flow_.get()),
      newton_(dae),
      workspace_(dae.make_workspace()),
      sample_(initial_state_of(dae)) {
  validate(options);
  if (!options_.on_event) options_.on_event = [](const DaeEvent&) {};
  before_.resize(dae.num_guards());
  after_.resize(dae.num_guards());
  values_.resize(dae.num_guards());
  is_armed_.resize(static_cast<std::size_t>(dae.num_guards()));
}

IntegrationResult HybridIntegrator::advance(DaeState& state, double t_end) {
  result_ = {};
  const auto steps_taken = [&] { return flow_->steps() + exact_->steps(); };
  const long steps = steps_taken(), rejected = flow_->rejected(), evaluations = flow_->evaluations();
  const auto finish = [&] {
    left_ = state;
    result_.steps = steps_taken() - steps;
    result_.rejected = flow_->rejected() - rejected;
    result_.evaluations = flow_->evaluations() - evaluations;
    return result_;
  };
  if (!is_started_) t_start_ = state.t;
  if (!is_where_we_left(state) && !restart(state, {}, false)) return finish();
  if (!is_started_ && options_.output_step > 0) {
    outputs_ = 1;
    if (!emit(state)) return finish();
  }
  is_started_ = true;

  while (state.t < t_end && !is_same_time(state.t, t_end)) {
    const double t_clock = dae_.next_event_time(state);
    const double t_limit = std::min(t_end, t_clock);
    if (t_limit > state.t && !is_same_time(t_limit, state.t)) {
      if (steps_taken() - steps >= options_.max_steps) {
        fail(IntegrationStatus::step_limit, state, std::to_string(options_.max_steps) + " steps are used up");
        return finish();
      }
      switch (current_->step(t_limit, std::min(options_.max_step, dae_.max_step(state, workspace_)))) {
        case Flow::Step::taken:
          break;
        case Flow::Step::collapsed:
          fail(IntegrationStatus::step_collapse, state, "the step collapses" + suspects(state));
          return finish();
        case Flow::Step::failed:
          fail(IntegrationStatus::no_consistent_state, state, why_inconsistent(state));
          return finish();
      }
      Crossing crossing;
      if (find_crossing(crossing)) {
        if (!land(crossing, state) || !strike(state, crossing.fired)) return finish();
        continue;
      }
      const bool is_struck = t_clock <= t_end && is_same_time(current_->end(), t_clock);
      if (!(is_struck ? current_->land(current_->end(), state) : current_->interpolate(current_->end(), state))) {
        fail(IntegrationStatus::no_consistent_state, state, why_inconsistent(state));
        return finish();
      }
      if (!is_struck && !write_outputs(state.t)) return finish();
    }
    if (t_clock <= t_end && is_same_time(state.t, t_clock)) {
      state.t = t_clock;
      if (!strike(state, {})) return finish();
    }
  }
  state.t = t_end;
  return finish();
}

bool HybridIntegrator::is_where_we_left(const DaeState& state) const {
  return is_started_ && state.t == left_.t && state.mode == left_.mode && state.x == left_.x && state.u == left_.u;
}

/// Consistent, and no level asks for another mode.
bool HybridIntegrator::settle(DaeState& state, std::span<const int> fired, bool is_consistent) {
  for (int k = 0; k < options_.max_events_at_once; ++k, is_consistent = false) {
    if (dae_.has_manifold(state.mode) && !dae_.project(state.mode, state.t, state.x, workspace_))
      return fail(IntegrationStatus::no_consistent_state, state, "the position constraints cannot be closed" + suspects(state));
    if ((!is_consistent || dae_.has_manifold(state.mode)) && !make_consistent(dae_, newton_, state, workspace_))
      return fail(IntegrationStatus::no_consistent_state, state, why_inconsistent(state));
    const Transition transition = dae_.transition(state, fired, workspace_, options_.on_event);
    if (!transition.failure.empty()) return fail(IntegrationStatus::transition_failed, state, transition.failure);
    if (!transition.changed) return true;
    fired = {};
    ++result_.events;
  }
  return fail(IntegrationStatus::too_many_events, state,
              std::to_string(options_.max_events_at_once) + " events at one instant" + suspects(state));
}

bool HybridIntegrator::restart(DaeState& state, std::span<const int> fired, bool is_consistent) {
  if (!settle(state, fired, is_consistent)) return false;
  sample_.mode = state.mode;
  sample_.u = state.u;
  current_ = dae_.has_exact_flow(state.mode) ? exact_.get() : flow_.get();
  reads_derivatives_ = dae_.guards_read_derivatives(state.mode);
  if (!current_->restart(state)) return fail(IntegrationStatus::step_collapse, state, "the integrator cannot start");
  evaluate_guards(state, before_);
  for (std::size_t i = 0; i < is_armed_.size(); ++i) is_armed_[i] = before_[static_cast<int>(i)] > 0;
  return true;
}

/// An event at a consistent state, and its rows.
bool HybridIntegrator::strike(DaeState& state, std::span<const int> fired) {
  if (!options_.on_output) return restart(state, fired, true);
  if (!write_outputs(state.t, true)) return false;
  struck_ = state;
  const bool goes_on = restart(state, fired, true);
  const bool jumps = !goes_on || state.x != struck_.x || state.mode.discrete != struck_.mode.discrete;
  const bool is_due = options_.output_step > 0 && (next_output() <= state.t || is_same_time(next_output(), state.t));
  if (is_due) ++outputs_;
  if (jumps && !emit(struck_)) return false;
  return goes_on && (!(jumps || is_due) || emit(state));
}

/// The output steps up to t_last; where an event stands there, those before it.
bool HybridIntegrator::write_outputs(double t_last, bool is_event) {
  if (!(options_.output_step > 0)) return true;
  for (;; ++outputs_) {
    const double t = next_output();
    const bool is_last = is_same_time(t, t_last);
    if (is_last ? is_event : t > t_last) return true;
    if (!current_->interpolate(std::min(t, t_last), sample_)) return true;
    sample_.t = t;
    if (!emit(sample_)) {
      ++outputs_;
      return false;
    }
  }
}

bool HybridIntegrator::emit(const DaeState& state) {
  if (!options_.on_output || options_.on_output(state)) return true;
  result_.status = IntegrationStatus::stopped;
  return false;
}

std::string HybridIntegrator::why_inconsistent(const DaeState& state) {
  const std::string what = "no consistent multipliers";
  return dae_.has_manifold(state.mode) ? what + suspects(state) : what + "; the system is " + newton_.diagnose(state, workspace_).text();
}

/// What is not finite; else what changes fastest, and what acts.
std::string HybridIntegrator::suspects(const DaeState& state) const {
  const auto listed = [](const std::string& what, const std::vector<std::string>& names) {
    std::string text = names.empty() ? "" : "; " + what + ":";
    for (std::size_t k = 0; k < std::min(names.size(), kMostSuspects); ++k) text += (k == 0 ? " " : ", ") + names[k];
    return names.size() > kMostSuspects ? text + " and " + std::to_string(names.size() - kMostSuspects) + " more" : text;
  };
  std::vector<std::string> wrong, acting;
  int fastest = -1;
  for (int i = 0; i < dae_.num_states(); ++i) {
    if (!std::isfinite(state.x[i]) || !std::isfinite(state.xdot[i])) wrong.push_back(dae_.state_name(i));
    if (fastest < 0 || std::abs(state.xdot[i]) > std::abs(state.xdot[fastest])) fastest = i;
  }
  for (int i = 0; i < dae_.num_algebraics(); ++i) {
    if (!std::isfinite(state.y[i])) wrong.push_back(dae_.algebraic_name(i));
    if (state.y[i] != 0) acting.push_back(dae_.algebraic_name(i));
  }
  if (!wrong.empty()) return listed("not finite", wrong);
  return listed("fastest", fastest < 0 ? acting : std::vector{dae_.state_name(fastest)}) + listed("acting", acting);
}

bool HybridIntegrator::fail(IntegrationStatus status, const DaeState& state, const std::string& why) {
  result_.status = status;
  result_.explanation = "t = " + std::to_string(state.t) + " s: " + why;
  return false;
}

}  // namespace tenon
