#include "tenon/core/plan.hpp"

#include <algorithm>
#include <utility>

namespace tenon {

// l_j = prod_{k != j} (tau - c_k)/(c_j - c_k),     l_j' = sum_{i != j} 1/(c_j - c_i) prod_{k != i, j} (tau - c_k)/(c_j - c_k)
void interpolation_weights(ConstVectorRef points, double tau, VectorRef value, VectorRef derivative) {
  const Eigen::Index n = points.size();
  for (Eigen::Index j = 0; j < n; ++j) {
    value[j] = 1, derivative[j] = 0;
    for (Eigen::Index k = 0; k < n; ++k) {
      if (k == j) continue;
      const double width = points[j] - points[k], factor = (tau - points[k]) / width;
      derivative[j] = derivative[j] * factor + value[j] / width;
      value[j] *= factor;
    }
  }
}

Plan::Plan(Vector abscissae, std::vector<PlanInterval> intervals, std::vector<DaeMode> modes)
    : abscissae_(std::move(abscissae)), intervals_(std::move(intervals)), modes_(std::move(modes)) {}

DaeState Plan::at(std::size_t k, double tau) const {
  const PlanInterval& interval = intervals_[k];
  const Eigen::Index n = abscissae_.size();
  Vector value(n), derivative(n);
  interpolation_weights(abscissae_, tau, value, derivative);
  DaeState state;
  state.t = tau == 1 && k + 1 < intervals_.size() ? intervals_[k + 1].t : interval.t + tau * interval.length;  // never back by rounding
  state.mode = modes_[static_cast<std::size_t>(interval.phase)];
  state.x = interval.x * value;
  state.xdot = interval.x * derivative / interval.length;
  interpolation_weights(abscissae_.tail(n - 1), tau, value.head(n - 1), derivative.head(n - 1));
  state.y = interval.y * value.head(n - 1);
  state.u = interval.u;
  return state;
}

DaeState Plan::at(double t) const {
  const auto later =
      std::upper_bound(intervals_.begin(), intervals_.end(), t, [](double time, const PlanInterval& i) { return time < i.t; });
  const std::size_t k = later == intervals_.begin() ? 0 : static_cast<std::size_t>(later - intervals_.begin()) - 1;
  return at(k, std::clamp((t - intervals_[k].t) / intervals_[k].length, 0.0, 1.0));
}

std::vector<DaeState> Plan::samples(int points) const {
  std::vector<DaeState> states;
  for (std::size_t k = 0; k < intervals_.size(); ++k) {
    const bool ends_phase = k + 1 == intervals_.size() || intervals_[k + 1].phase != intervals_[k].phase;
    for (int i = 0; i < points + (ends_phase ? 1 : 0); ++i) states.push_back(at(k, static_cast<double>(i) / points));
  }
  return states;
}

}  // namespace tenon
