// Small DAEs with known solutions.
#pragma once

#include <algorithm>
#include <cmath>

#include "tenon/core/dae.hpp"

namespace tenon {

/// xdot = -k (x - cos t) - sin t, y = x^2, written implicitly: x = cos t from x(0) = 1.
struct StiffRelaxation : Dae {
  double k = 1e4;
  int num_states() const override { return 1; }
  int num_algebraics() const override { return 1; }
  void initial_state(DaeState& state) const override { state.x[0] = 1; }
  void residual(const DaeMode&, const DaePoint& at, Workspace&, VectorRef F) const override {
    F[0] = at.xdot[0] + k * (at.x[0] - std::cos(at.t)) + std::sin(at.t);
    F[1] = at.y[0] - at.x[0] * at.x[0];
  }
  void jacobian(const DaeMode&, const DaePoint& at, double alpha, Workspace&, std::span<double> values) const override {
    values[0] = alpha + k, values[1] = -2 * at.x[0], values[2] = 0, values[3] = 1;
  }
};

/// A point on a circle of radius 1 under gravity 1, with its multiplier:  rddot = -(0, 1) + lambda r,  r'r = 1 with Baumgarte's terms.
struct PlanarPendulum : Dae {
  double p = 5;             // Baumgarte's pole
  bool is_index_3 = false;  // the constraint itself in place of its second derivative
  double angle = 1;         // from below, rad, at rest
  int num_states() const override { return 4; }
  int num_algebraics() const override { return 1; }
  void initial_state(DaeState& state) const override { state.x << std::sin(angle), -std::cos(angle), 0, 0; }
  void residual(const DaeMode&, const DaePoint& at, Workspace&, VectorRef F) const override {
    const auto r = at.x.head<2>(), v = at.x.tail<2>();
    F.head<2>() = at.xdot.head<2>() - v;
    F.segment<2>(2) = at.xdot.tail<2>() + Eigen::Vector2d(0, 1) - at.y[0] * r;
    const double h = 0.5 * (r.squaredNorm() - 1);
    F[4] = is_index_3 ? h : r.dot(at.xdot.tail<2>()) + v.squaredNorm() + 2 * p * r.dot(v) + p * p * h;
  }
  void jacobian(const DaeMode&, const DaePoint& at, double alpha, Workspace&, std::span<double> values) const override {
    Eigen::Map<Eigen::Matrix<double, 5, 5>> J(values.data());
    const auto r = at.x.head<2>(), v = at.x.tail<2>();
    J.setZero();
    J.topLeftCorner<2, 2>() = alpha * Eigen::Matrix2d::Identity();
    J.block<2, 2>(0, 2) = -Eigen::Matrix2d::Identity();
    J.block<2, 2>(2, 0) = -at.y[0] * Eigen::Matrix2d::Identity();
    J.block<2, 2>(2, 2) = alpha * Eigen::Matrix2d::Identity();
    J.block<2, 1>(2, 4) = -r;
    J.block<1, 2>(4, 0) =
        is_index_3 ? Eigen::RowVector2d(r.transpose()) : Eigen::RowVector2d((at.xdot.tail<2>() + 2 * p * v + p * p * r).transpose());
    if (!is_index_3) J.block<1, 2>(4, 2) = (alpha * r + 2 * v + 2 * p * r).transpose();
  }
  static double energy(const Vector& x) { return 0.5 * x.tail(2).squaredNorm() + x[1]; }
};

/// A ball that loses its speed's sign and a share 1 - e of it at height 0, by its guard; a clock strikes every `period` and counts.
struct JumpingBall : Dae {
  double e = 0.5, height = 1, period = 0.3;
  int num_states() const override { return 2; }
  int num_algebraics() const override { return 0; }
  int num_guards() const override { return 1; }
  void initial_state(DaeState& state) const override {
    state.x << height, 0;
    state.mode.discrete = {0, 0};  // bounces, strikes
    state.mode.held.setConstant(1, period);
  }
  void residual(const DaeMode&, const DaePoint& at, Workspace&, VectorRef F) const override {
    F << at.xdot[0] - at.x[1], at.xdot[1] + 9.81;
  }
  void jacobian(const DaeMode&, const DaePoint&, double alpha, Workspace&, std::span<double> values) const override {
    values[0] = alpha, values[1] = 0, values[2] = -1, values[3] = alpha;
  }
  void guards(const DaeMode&, const DaePoint& at, Workspace&, VectorRef values) const override { values[0] = at.x[0]; }
  double next_event_time(const DaeState& state) const override { return state.mode.held[0]; }
  Transition transition(DaeState& state, std::span<const int> fired, Workspace&, const EventLog& log) const override {
    if (!fired.empty()) {
      DaeEvent event{.t = state.t, .contact = "ground", .gap = state.x[0], .gap_rate_before = state.x[1]};
      state.x[1] *= -e;
      event.gap_rate_after = state.x[1];
      ++state.mode.discrete[0];
      log(event);
      return {.changed = true};
    }
    if (state.t < state.mode.held[0]) return {};
    ++state.mode.discrete[1];
    state.mode.held[0] = period * (1 + state.mode.discrete[1]);
    return {.changed = true};
  }
};

}  // namespace tenon
