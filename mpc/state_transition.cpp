#include "tenon/mpc/state_transition.hpp"

#include <cmath>

#include "tenon/mpc/pattern_entries.hpp"

namespace tenon {

StateTransition::StateTransition(const Dae& dae, const DaeMode& mode, double longest_step)
    : state(Vector::Zero(dae.num_states())),
      derivative(Eigen::MatrixXd::Identity(state.size(), state.size() + dae.num_inputs())),
      dae_(dae),
      mode_(mode),
      longest_step_(longest_step),
      workspace_(dae.make_workspace()),
      pattern_(dae.jacobian_pattern()),
      input_pattern_(dae.input_jacobian_pattern()),
      values_(static_cast<std::size_t>(pattern_.nonzeros())),
      input_values_(static_cast<std::size_t>(input_pattern_.nonzeros())),
      at_(state),
      moved_(derivative),
      by_x_(Eigen::MatrixXd::Zero(state.size(), state.size())) {
  rate_.fill(state);
  derivative_rate_.fill(derivative);
}

void StateTransition::advance(ConstVectorRef x, ConstVectorRef u, double dt) {
  state = x;
  derivative.setIdentity();
  if (!(dt > 0)) return;
  const int steps = static_cast<int>(std::ceil(dt / longest_step_ * (1 - 1e-9)));
  for (int k = 0; k < steps; ++k) step(dt / steps, u);
}

// k_i and K_i = df/dx S + [0, df/du] at what stands in at_ and moved_
void StateTransition::rates(std::size_t stage, ConstVectorRef u) {
  dae_.derivatives(mode_, 0, at_, u, workspace_, rate_[stage], none_);
  const DaePoint point(0, rate_[stage], at_, none_, u);
  dae_.jacobian(mode_, point, 0, workspace_, values_);
  dae_.input_jacobian(mode_, point, workspace_, input_values_);
  by_x_.setZero();
  for_each_entry(pattern_, [&](int r, int c, std::size_t e) { by_x_(r, c) = -values_[e]; });
  derivative_rate_[stage].noalias() = by_x_ * moved_;
  for_each_entry(input_pattern_, [&](int r, int c, std::size_t e) { derivative_rate_[stage](r, state.size() + c) -= input_values_[e]; });
}

void StateTransition::step(double h, ConstVectorRef u) {
  constexpr std::array kNodes{0.0, 0.5, 0.5, 1.0}, kWeights{1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};
  at_ = state;
  moved_ = derivative;
  for (std::size_t i = 0; i < kNodes.size(); ++i) {
    if (i > 0) {
      at_ = state + h * kNodes[i] * rate_[i - 1];
      moved_ = derivative + h * kNodes[i] * derivative_rate_[i - 1];
    }
    rates(i, u);
  }
  for (std::size_t i = 0; i < kNodes.size(); ++i) {
    state += h * kWeights[i] * rate_[i];
    derivative += h * kWeights[i] * derivative_rate_[i];
  }
}

}  // namespace tenon
