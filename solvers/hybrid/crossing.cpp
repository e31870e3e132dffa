// Where the guards fall: looked for within a step, located, landed on.
#include <algorithm>
#include <cmath>
#include <limits>

#include "tenon/solvers/hybrid/hybrid_integrator.hpp"

namespace tenon {

namespace {

constexpr int kSamples = 3;  // a step's end, and two points inside it
constexpr int kMaxBisections = 200;
constexpr int kFewSecants = 8;
constexpr int kMaxLandings = 4;

}  // namespace

void HybridIntegrator::evaluate_guards(const DaeState& state, Vector& values) {
  if (values.size() > 0) dae_.guards(state.mode, DaePoint(state), workspace_, values);
}

/// What the guards need of the state at t.
bool HybridIntegrator::look(double t) {
  return reads_derivatives_ ? current_->interpolate(t, sample_) : current_->interpolate_state(t, sample_);
}

double HybridIntegrator::guard_at(double t, int guard) {
  look(t);
  evaluate_guards(sample_, values_);
  return values_[guard];
}

/// The first guard that falls within the last step, if any does.
bool HybridIntegrator::find_crossing(Crossing& crossing) {
  if (before_.size() == 0) return false;
  const double a = current_->begin(), b = current_->end();
  double left = a;
  for (int k = 1; k <= kSamples; ++k) {
    const double right = k == kSamples ? b : a + (b - a) * k / kSamples;
    if (!look(right)) return false;
    evaluate_guards(sample_, after_);
    int first = -1;
    const auto find_earlier = [&](double t_fallen) {
      const double before = first < 0 ? std::numeric_limits<double>::infinity() : crossing.t;
      for (int i = 0; i < after_.size(); ++i) {
        if (i == first || !is_armed_[static_cast<std::size_t>(i)] || after_[i] > 0) continue;
        if (first >= 0 && guard_at(crossing.t, i) > 0) continue;  // falls later
        const double t = locate(i, left, t_fallen);
        if (first < 0 || t < crossing.t) first = i, crossing.t = t;
      }
      return first >= 0 && crossing.t < before - options_.event_tolerance;
    };
    // what is up again at the sample may have fallen before the others: looked at where the first of them fell
    for (double t = right; find_earlier(t); t = crossing.t) {
      look(crossing.t);
      evaluate_guards(sample_, after_);
    }
    if (first >= 0) {
      crossing.fired.push_back(first);
      for (int i = 0; i < after_.size(); ++i) {
        if (i != first && is_armed_[static_cast<std::size_t>(i)] && after_[i] <= 0) crossing.fired.push_back(i);
      }
      return true;
    }
    for (int i = 0; i < after_.size(); ++i) is_armed_[static_cast<std::size_t>(i)] |= after_[i] > 0;
    std::swap(before_, after_);
    left = right;
  }
  return false;
}

/// The upper end of an interval of width event_tolerance in which the guard falls: regula falsi, the value of an end that stays weighted
/// by what the other's fell to, and bisection where that is slow.
/// Source: N. Anderson, A. Bjorck, BIT 13 (1973) 253.
double HybridIntegrator::locate(int guard, double a, double b) {
  double ga = guard_at(a, guard), gb = guard_at(b, guard);
  if (!(ga > 0)) ga = before_[guard] > 0 ? before_[guard] : std::abs(gb);
  int side = 0;
  for (int k = 0; k < kMaxBisections && b - a > options_.event_tolerance && !is_same_time(a, b); ++k) {
    double t = k % 3 == 2 && k > kFewSecants ? 0.5 * (a + b) : (a * gb - b * ga) / (gb - ga);
    if (!(t > a && t < b)) t = 0.5 * (a + b);
    const double inside = 0.5 * options_.event_tolerance;  // a root beside an end closes the interval from the other side
    t = std::clamp(t, std::min(a + inside, 0.5 * (a + b)), std::max(b - inside, 0.5 * (a + b)));
    const double g = guard_at(t, guard);
    const double fell = 1 - g / (g <= 0 ? gb : ga), weight = fell > 0 ? fell : 0.5;
    if (g <= 0) {
      b = t, gb = g;
      if (side == -1) ga *= weight;
      side = -1;
    } else {
      a = t, ga = g;
      if (side == 1) gb *= weight;
      side = 1;
    }
  }
  return b;
}

/// The state at the crossing, as accurate as a step: the instant itself is corrected where the interpolant was off.
bool HybridIntegrator::land(Crossing& crossing, DaeState& state) {
  const int guard = crossing.fired.front();
  const double delta = 1e-3 * (current_->end() - current_->begin());
  const double t0 = std::max(current_->begin(), crossing.t - delta), t1 = std::min(current_->end(), t0 + 2 * delta);
  const double slope = (guard_at(t1, guard) - guard_at(t0, guard)) / (t1 - t0);
  for (int k = 0; k < kMaxLandings; ++k) {
    if (!current_->land(crossing.t, state)) return fail(IntegrationStatus::no_consistent_state, state, why_inconsistent(state));
    evaluate_guards(state, values_);
    const double correction = -values_[guard] / slope;
    if (!(std::abs(correction) > options_.event_tolerance) || !(std::abs(correction) < delta)) break;
    crossing.t = std::clamp(crossing.t + correction, current_->begin(), current_->end());
  }
  // a guard that jumps has no zero to land on: the next mode starts where it has fallen, or this event would come back for ever
  for (double ahead = options_.event_tolerance; values_[guard] > 0 && crossing.t < current_->end(); ahead *= 2) {
    crossing.t = std::min(crossing.t + ahead, current_->end());
    if (!current_->land(crossing.t, state)) return fail(IntegrationStatus::no_consistent_state, state, why_inconsistent(state));
    evaluate_guards(state, values_);
  }
  return true;
}

}  // namespace tenon
