// The usual time-stepper of rigid bodies in contact, to stand beside the hybrid DAE: fixed steps, and in each one linear complementarity
// problem in impulses, by projected Gauss-Seidel.
//
//     M (v+ - v) = dt Q + H'p,    q+ = q + dt v+
//     contact that closes within the step   0 <= p,  H v+ + e H v- >= 0,  complementary        joint   H v+ = -h / (5 dt)
//
// Source: J. J. Moreau, Unilateral contact and dry friction in finite freedom dynamics, CISM 302 (1988); D. E. Stewart, J. C. Trinkle,
// Int. J. Numer. Meth. Engng. 39 (1996) 2673.
#pragma once

#include "tenon/problems/contact/contact_dae.hpp"

namespace tenon {

class LcpTimeStepper {
 public:
  explicit LcpTimeStepper(const contact::ContactDae<2>& dae) : dae_(dae), workspace_(dae.make_workspace()), state_(initial_state_of(dae)) {
    std::fill(state_.mode.discrete.begin(), state_.mode.discrete.end(), int{contact::kFree});
    for (const auto& body : dae.scene().bodies) {
      for (int l = 0; l < body.freedoms; ++l) q_.push_back(at_ + l), v_.push_back(at_ + body.freedoms + l);
      for (int l = 0; l < body.freedoms; ++l) inverse_mass_.push_back(l < 2 ? 1 / body.mass : 1 / body.inertia[0]);
      first_.push_back(static_cast<int>(v_.size()) - body.freedoms);
      at_ += 2 * body.freedoms;
    }
  }

  void step(double dt) {
    dae_.derivatives(state_.mode, state_.t, state_.x, state_.u, workspace_, state_.xdot, state_.y);
    const int n = static_cast<int>(v_.size()), m = dae_.num_constraints();
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(m, n);
    Vector least(m), v(n), p = Vector::Zero(m);
    for (int k = 0; k < n; ++k) v[k] = state_.x[v_[at(k)]] + dt * state_.xdot[v_[at(k)]];
    for (int i = 0; i < m; ++i) {
      const auto& c = dae_.scene().constraints[at(i)];
      const auto g = dae_.gap(i, state_.t, state_.x, workspace_);
      for (const auto& [body, gradient] : {std::pair(c.a, g.H_A), std::pair(c.b, g.H_B)}) {
        if (body == contact::kWorld) continue;
        const int freedoms = dae_.scene().bodies[at(body)].freedoms;
        H.row(i).segment(first_[at(body)], freedoms) += gradient.head(freedoms).transpose();
      }
      const bool closes = g.h + dt * std::min(g.rate, 0.0) <= 0;
      least[i] = c.is_joint() ? -0.2 * g.h / dt : closes ? -c.restitution * std::min(g.rate, 0.0) : -g.h / dt;
    }
    const Eigen::MatrixXd lift = Eigen::Map<const Vector>(inverse_mass_.data(), n).asDiagonal() * H.transpose();
    for (int sweep = 0; sweep < 10'000; ++sweep) {
      double change = 0;
      for (int i = 0; i < m; ++i) {
        double next = p[i] + (least[i] - H.row(i).dot(v)) / H.row(i).dot(lift.col(i));
        if (!dae_.scene().constraints[at(i)].is_joint()) next = std::max(next, 0.0);
        change = std::max(change, std::abs(next - p[i]));
        v += lift.col(i) * (next - p[i]);
        p[i] = next;
      }
      if (change <= 1e-12) break;
    }
    for (int k = 0; k < n; ++k) {
      state_.x[v_[at(k)]] = v[k];
      state_.x[q_[at(k)]] += dt * v[k];
    }
    state_.t += dt;
    forces_ = p / dt;
  }

  const DaeState& state() const { return state_; }
  double energy() { return dae_.energy(state_.t, state_.x, workspace_); }
  /// Of each constraint in the last step, N.
  const Vector& forces() const { return forces_; }

 private:
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }

  const contact::ContactDae<2>& dae_;
  Dae::Workspace workspace_;
  DaeState state_;
  Vector forces_;
  std::vector<int> q_, v_, first_;  // where in x, and where among all velocities a body's are
  std::vector<double> inverse_mass_;
  int at_ = 0;
};

}  // namespace tenon
