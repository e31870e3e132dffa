#include "tenon/problems/soft_walls/model.hpp"

#include <algorithm>
#include <stdexcept>

namespace tenon::soft_walls {

Model::Model(const Parameters& parameters) : parameters_(parameters) {
  const Parameters& p = parameters_;
  if (!(std::min({p.pole_mass, p.cart_mass, p.pole_length, p.com_length, p.stiffness, p.step}) > 0)) {
    throw std::invalid_argument("a mass, a length, the stiffness or the step of the walls' model is not positive (expected more than 0)");
  }
  const double g = p.gravity, mp = p.pole_mass, mc = p.cart_mass, l = p.com_length, length = p.pole_length;
  Eigen::Matrix4d rate;
  rate << 0, 0, 1, 0,
          0, 0, 0, 1,
          0, g * mp / mc, 0, 0,
          0, g * (mc + mp) / (l * mc), 0, 0;
  a_ = Eigen::Matrix4d::Identity() + p.step * rate;
  b_ = p.step * State(0, 0, 1 / mc, 1 / (l * mc));
  d_ = p.step * State(0, 0, -1 / mc + length / (mc * l), -1 / (mc * l) + length * (mc + mp) / (mc * mp * l * l));
  tip_ = State(1, -length, 0, 0);
}

double Model::wall_force(double p) const {
  return parameters_.stiffness * (std::max(0.0, p - parameters_.wall) - std::max(0.0, -p - parameters_.wall));
}

Eigen::RowVector4d regulator_gain(const Model& model, const Weights& weights, const Eigen::Matrix4d& p) {
  const State pb = p * model.b();
  return pb.transpose() * model.a() / (weights.input + model.b().dot(pb));
}

Eigen::Matrix4d riccati_solution(const Model& model, const Weights& weights) {
  constexpr int kMostIterations = 100000;
  constexpr double kTolerance = 1e-12;  // relative
  const Eigen::Matrix4d q = weights.state.asDiagonal();
  Eigen::Matrix4d p = q;
  for (int k = 0; k < kMostIterations; ++k) {
    const Eigen::Matrix4d closed = model.a() - model.b() * regulator_gain(model, weights, p);
    const Eigen::Matrix4d step = q + model.a().transpose() * p * closed;
    const Eigen::Matrix4d next = (step + step.transpose()) / 2;
    const bool settled = (next - p).lpNorm<Eigen::Infinity>() <= kTolerance * next.lpNorm<Eigen::Infinity>();
    p = next;
    if (settled) return p;
  }
  throw std::invalid_argument("the Riccati equation of the soft walls' terminal cost does not settle (expected weights more than 0)");
}

}  // namespace tenon::soft_walls
