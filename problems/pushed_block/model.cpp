#include "tenon/problems/pushed_block/model.hpp"

#include <cmath>

#include "tenon/core/automatic_dae.hpp"
#include "tenon/core/automatic_function.hpp"

namespace tenon::pushed_block {

namespace {

template <class T>
T pad_force(const Parameters& p, const T& overlap) {
  using std::exp, std::log;
  const T s = overlap / p.softness;
  return p.stiffness * p.softness * (s > 0 ? s + log(1 + exp(-s)) : log(1 + exp(s)));
}

struct FingerAndBlock {
  static constexpr int kStates = pushed_block::kStates, kAlgebraics = 0, kInputs = 1;

  Parameters parameters;

  template <class T>
  void equations(const DaeMode&, const std::array<T, kStates>& x, const std::array<T, 0>&, const std::array<T, 1>& u,
                 std::array<T, kStates>& xdot, std::array<T, 0>&) const {
    const Parameters& p = parameters;
    const T lambda = pad_force<T>(p, x[kFinger] - x[kBlock]);
    const T braking = x[kFriction] * p.gravity * tanh(x[kBlockRate] / p.slip_speed);
    xdot = {x[kFingerRate], x[kBlockRate], (u[0] - lambda) / p.finger_mass, lambda / x[kBlockMass] - braking, T(0), T(0)};
  }
  void initial_state(DaeState&) const {}
  std::string state_name(int i) const { return kStateNames[static_cast<std::size_t>(i)]; }
  std::string input_name(int) const { return "force"; }
};

}  // namespace

double contact_force(const Parameters& parameters, const State& x) {
  return pad_force(parameters, x[kFinger] - x[kBlock]);
}

// A friction that is held for a period and then drawn anew adds to a velocity what a random walk does:  sigma T / m a period, each period
EstimationProblem estimation_problem(const Parameters& parameters, const Prior& prior, int window) {
  EstimationProblem problem(std::make_shared<AutomaticDae<FingerAndBlock>>(FingerAndBlock{parameters}),
                            automatic_function<kStates + 1, 1>([](const auto& z, auto& y) { y[0] = z[kFinger]; }, {"finger"}));
  problem.name = "pushed block";
  problem.noise << parameters.noise;
  problem.mean = prior.mean;
  problem.deviation = prior.deviation;
  problem.is_positive[kBlockMass] = problem.is_positive[kFriction] = true;
  problem.ripple[0] = parameters.force_ripple;
  problem.drift[kBlockRate] = parameters.friction_ripple / prior.mean[kBlockMass] * std::sqrt(parameters.period);
  problem.window = window;
  problem.longest_step = parameters.period / 2;
  problem.solve.tolerance = 1e-6;
  problem.solve.max_iterations = 5;  // the next window goes on from there
  return problem;
}

}  // namespace tenon::pushed_block
