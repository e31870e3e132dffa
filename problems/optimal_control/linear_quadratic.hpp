// A linear-quadratic optimal control problem with boxed inputs:
//
//     min  1/2 sum_k ( x_k' Q x_k + u_k' R u_k ) + 1/2 x_N' Q x_N     s.t.   A x_k + B u_k - x_{k+1} = 0,   |u_k| <= u_max,   x_0 given
//
// Q and R diagonal. Variables are ordered x_0 u_0 x_1 u_1 ... x_N, rows by interval. The instance at hand is a chain of masses and springs
// whose first masses are pushed, the usual test of solvers for model-predictive control (HPIPM, qpOASES).
#pragma once

#include "tenon/core/nlp.hpp"

namespace tenon {

struct LinearQuadraticProgram {
  Eigen::MatrixXd a, b;  // nx x nx, nx x nu
  Vector state_weight;   // nx: diagonal of Q
  Vector input_weight;   // nu: diagonal of R
  double largest_input = kInfinity<double>;
  Vector initial;      // nx
  int intervals = 20;  // N
};

/// Masses of 1 kg between springs of 1 N/m and walls, sampled at 0.5 s with the inputs held: states are all positions, then all velocities.
/// States: even; inputs push the first masses. Throws std::invalid_argument where there are more inputs than masses.
LinearQuadraticProgram mass_spring_chain(int states, int inputs, int intervals);

/// States, Inputs: constants, so that the linear algebra is of that size; or Dynamic, both.
template <int States, int Inputs>
class LinearQuadratic final : public Nlp {
 public:
  using StageSizes = tenon::StageSizes<States, Inputs>;

  explicit LinearQuadratic(LinearQuadraticProgram program) : program_(std::move(program)) {}

  void set_initial_state(const Vector& state) { program_.initial = state; }

  int num_variables() const override { return stage_size() * program_.intervals + states(); }
  int num_constraints() const override { return states() * program_.intervals; }

  Stages stages() const override {
    Stages stages;
    for (int k = 0; k < program_.intervals; ++k) {
      stages.stages.push_back({{stage_size() * k, stage_size() * (k + 1)}, {states() * k, states() * (k + 1)}});
    }
    stages.stages.push_back({{stage_size() * program_.intervals, num_variables()}, {num_constraints(), num_constraints()}});
    return stages;
  }

  // Each column of an interval is one of [A B]; a state has the -1 of the row before in front of it.
  SparsePattern jacobian_pattern() const override {
    SparsePattern pattern{num_constraints(), num_variables(), {0}, {}};
    for (int i = 0; i < num_variables(); ++i) {
      const int k = i / stage_size(), c = i % stage_size();
      if (c < states() && k > 0) pattern.inner.push_back(states() * (k - 1) + c);
      for (int r = 0; r < states() && k < program_.intervals; ++r) pattern.inner.push_back(states() * k + r);
      pattern.outer.push_back(pattern.nonzeros());
    }
    return pattern;
  }
  SparsePattern hessian_pattern() const override {
    SparsePattern pattern{num_variables(), num_variables(), {0}, {}};
    for (int i = 0; i < num_variables(); ++i) pattern.inner.push_back(i), pattern.outer.push_back(i + 1);
    return pattern;
  }

  void bounds(Bounds& bounds) const override {
    for (int k = 0; k < program_.intervals; ++k) {
      bounds.x_lower.segment(stage_size() * k + states(), inputs()).setConstant(-program_.largest_input);
      bounds.x_upper.segment(stage_size() * k + states(), inputs()).setConstant(program_.largest_input);
    }
    bounds.x_lower.head(states()) = bounds.x_upper.head(states()) = program_.initial;
    bounds.c_lower.setZero();
    bounds.c_upper.setZero();
  }

  double objective(ConstVectorRef x, Workspace&) const override {
    double sum = 0;
    for (int k = 0; k <= program_.intervals; ++k) {
      sum += x.segment(stage_size() * k, states()).cwiseAbs2().dot(program_.state_weight);
      if (k < program_.intervals) sum += x.segment(stage_size() * k + states(), inputs()).cwiseAbs2().dot(program_.input_weight);
    }
    return sum / 2;
  }
  void gradient(ConstVectorRef x, Workspace&, VectorRef gradient) const override {
    for (int k = 0; k <= program_.intervals; ++k) {
      gradient.segment(stage_size() * k, states()) = x.segment(stage_size() * k, states()).cwiseProduct(program_.state_weight);
      if (k == program_.intervals) break;
      const int u = stage_size() * k + states();
      gradient.segment(u, inputs()) = x.segment(u, inputs()).cwiseProduct(program_.input_weight);
    }
  }
  void constraints(ConstVectorRef x, Workspace&, VectorRef values) const override {
    const auto &a = matrix<States>(program_.a), &b = matrix<Inputs>(program_.b);
    for (int k = 0; k < program_.intervals; ++k) {
      auto row = values.segment<States>(states() * k, states());
      row = -x.segment<States>(stage_size() * (k + 1), states());
      row.noalias() += a * x.segment<States>(stage_size() * k, states());
      row.noalias() += b * x.segment<Inputs>(stage_size() * k + states(), inputs());
    }
  }
  void jacobian(ConstVectorRef, Workspace&, std::span<double> values) const override {
    double* out = values.data();
    for (int k = 0; k < program_.intervals; ++k) {
      for (int c = 0; c < stage_size(); ++c) {
        if (c < states() && k > 0) *out++ = -1;
        out = std::copy_n(c < states() ? program_.a.data() + c * states() : program_.b.data() + (c - states()) * states(), states(), out);
      }
    }
    std::fill_n(out, states(), -1.0);
  }
  void hessian(ConstVectorRef, double sigma, ConstVectorRef, Workspace&, std::span<double> values) const override {
    double* out = values.data();
    for (int k = 0; k <= program_.intervals; ++k) {
      for (const double weight : program_.state_weight) *out++ = sigma * weight;
      if (k == program_.intervals) break;
      for (const double weight : program_.input_weight) *out++ = sigma * weight;
    }
  }
  std::string name() const override { return "lq"; }

 private:
  int states() const { return States == Dynamic ? static_cast<int>(program_.a.cols()) : States; }
  int inputs() const { return Inputs == Dynamic ? static_cast<int>(program_.b.cols()) : Inputs; }
  int stage_size() const { return states() + inputs(); }
  template <int Columns>
  static auto matrix(const Eigen::MatrixXd& m) {
    return Eigen::Map<const Eigen::Matrix<double, States, Columns>>(m.data(), m.rows(), m.cols());
  }

  LinearQuadraticProgram program_;
};

}  // namespace tenon
