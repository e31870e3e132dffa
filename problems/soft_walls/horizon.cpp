#include "tenon/problems/soft_walls/horizon.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace tenon::soft_walls {

namespace {

constexpr int kStates = 4, kStage = 5;  // x, and u behind it

/// A function of one number, and its derivatives.
struct Derivatives {
  double value, slope, curvature;
};

// r = (s + h)/2,  r' = (1 + s/h)/2,  r'' = delta^2 / (2 h^3)   with  h = sqrt(s^2 + delta^2)
Derivatives rounded(double s, double rounding) {
  const double h = std::sqrt(s * s + rounding * rounding);
  return {(s + h) / 2, (1 + s / h) / 2, rounding * rounding / (2 * h * h * h)};
}

/// f by p.
Derivatives rounded_wall_force(const Parameters& parameters, double rounding, double p) {
  Derivatives f{0, 0, 0};
  for (const double side : {1.0, -1.0}) {
    const Derivatives r = rounded(side * p - parameters.wall, rounding);
    f.value += side * r.value;
    f.slope += r.slope;
    f.curvature += side * r.curvature;
  }
  return {parameters.stiffness * f.value, parameters.stiffness * f.slope, parameters.stiffness * f.curvature};
}

}  // namespace

Horizon::Horizon(const Model& model, const Weights& weights, int intervals, double rounding, const State& start)
    : model_(model),
      weights_(weights),
      intervals_(intervals),
      rounding_(rounding),
      start_(start),
      terminal_(riccati_solution(model, weights)),
      gain_(regulator_gain(model, weights, terminal_)) {
  if (intervals < 1) throw std::invalid_argument("a horizon of " + std::to_string(intervals) + " intervals (expected at least 1)");
  if (!(rounding > 0)) throw std::invalid_argument("the walls' law is rounded over " + std::to_string(rounding) + " m (expected more than 0)");
}

void Horizon::observe(double, ConstVectorRef measurements, ConstVectorRef) {
  start_ = measurements;
}

void Horizon::commands(const Point& plan, double elapsed, VectorRef commands) const {
  const int k = std::clamp(static_cast<int>(elapsed / interval() + 1e-6), 0, intervals_ - 1);
  commands[0] = plan.x[kStage * k + kStates];
}

std::string Horizon::plan_output_name(int i) const {
  static const char* const kNames[] = {"plan_x", "plan_theta", "plan_tip"};
  return kNames[i / intervals_] + std::to_string(i % intervals_ + 1);
}

void Horizon::plan_outputs(const Point& plan, VectorRef values) const {
  for (int k = 0; k < intervals_; ++k) {
    const State state = plan.x.segment<kStates>(kStage * (k + 1));
    const double foreseen[] = {state[0], state[1], model_.tip().dot(state)};
    for (int quantity = 0; quantity < 3; ++quantity) values[quantity * intervals_ + k] = foreseen[quantity];
  }
}

std::vector<std::string> Horizon::trajectory_columns() const {
  return {"x", "theta", "v", "omega", "tip", "lambda_right", "lambda_left", "gap_right", "gap_left", "mode_right", "mode_left", "u"};
}

void Horizon::trajectory(const Point& plan, int k, VectorRef values) const {
  const State state = plan.x.segment<kStates>(kStage * k);
  const double p = model_.tip().dot(state), wall = model_.parameters().wall, stiffness = model_.parameters().stiffness;
  const double right = wall - p, left = wall + p;
  values << state, p, stiffness * rounded(-right, rounding_).value, stiffness * rounded(-left, rounding_).value, right, left, right < 0 ? 2 : 0, left < 0 ? 2 : 0,
      plan.x[kStage * std::min(k, intervals_ - 1) + kStates];
}

Stages Horizon::stages() const {
  Stages stages;
  for (int k = 0; k <= intervals_; ++k) {
    const bool last = k == intervals_;
    stages.stages.push_back({{kStage * k, kStage * k + (last ? kStates : kStage)}, {kStates * k, kStates * (k + (last ? 0 : 1))}});
  }
  return stages;
}

// Each column of an interval is one of [A + D f' tip', B]; a state has the -1 of the row before in front of it.
SparsePattern Horizon::jacobian_pattern() const {
  SparsePattern pattern{num_constraints(), num_variables(), {0}, {}};
  for (int i = 0; i < num_variables(); ++i) {
    const int k = i / kStage, c = i % kStage;
    if (c < kStates && k > 0) pattern.inner.push_back(kStates * (k - 1) + c);
    for (int r = 0; r < kStates && k < intervals_; ++r) pattern.inner.push_back(kStates * k + r);
    pattern.outer.push_back(pattern.nonzeros());
  }
  return pattern;
}

// The diagonal, what the walls' curvature couples (position and angle), and all of P.
SparsePattern Horizon::hessian_pattern() const {
  std::vector<std::pair<int, int>> entries;
  for (int i = 0; i < num_variables(); ++i) entries.emplace_back(i, i);
  for (int k = 0; k < intervals_; ++k) entries.emplace_back(kStage * k + 1, kStage * k);
  const int last = kStage * intervals_;
  for (int column = 0; column < kStates; ++column) {
    for (int row = column; row < kStates; ++row) entries.emplace_back(last + row, last + column);
  }
  return SparsePattern::from_entries(num_variables(), num_variables(), std::move(entries));
}

void Horizon::bounds(Bounds& bounds) const {
  bounds.x_lower.head<kStates>() = bounds.x_upper.head<kStates>() = start_;
  bounds.c_lower.setZero();
  bounds.c_upper.setZero();
}

void Horizon::initial_point(VectorRef x) const {
  State state = start_;
  for (int k = 0; k < intervals_; ++k) {
    const double u = -gain_.dot(state);
    x.segment<kStates>(kStage * k) = state;
    x[kStage * k + kStates] = u;
    state = model_.next(state, u);
  }
  x.tail<kStates>() = state;
}

double Horizon::objective(ConstVectorRef x, Workspace&) const {
  double sum = x.tail<kStates>().dot(terminal_ * x.tail<kStates>());
  for (int k = 0; k < intervals_; ++k) {
    const double u = x[kStage * k + kStates];
    sum += x.segment<kStates>(kStage * k).cwiseAbs2().dot(weights_.state) + weights_.input * u * u;
  }
  return sum;
}

void Horizon::gradient(ConstVectorRef x, Workspace&, VectorRef gradient) const {
  for (int k = 0; k < intervals_; ++k) {
    gradient.segment<kStates>(kStage * k) = 2 * weights_.state.cwiseProduct(x.segment<kStates>(kStage * k));
    gradient[kStage * k + kStates] = 2 * weights_.input * x[kStage * k + kStates];
  }
  gradient.tail<kStates>() = 2 * terminal_ * x.tail<kStates>();
}

void Horizon::constraints(ConstVectorRef x, Workspace&, VectorRef values) const {
  for (int k = 0; k < intervals_; ++k) {
    const State state = x.segment<kStates>(kStage * k);
    const Derivatives f = rounded_wall_force(model_.parameters(), rounding_, model_.tip().dot(state));
    values.segment<kStates>(kStates * k) =
        model_.a() * state + model_.b() * x[kStage * k + kStates] + model_.d() * f.value - x.segment<kStates>(kStage * (k + 1));
  }
}

void Horizon::jacobian(ConstVectorRef x, Workspace&, std::span<double> values) const {
  double* out = values.data();
  for (int k = 0; k < intervals_; ++k) {
    const Derivatives f = rounded_wall_force(model_.parameters(), rounding_, model_.tip().dot(x.segment<kStates>(kStage * k)));
    const Eigen::Matrix4d by_state = model_.a() + f.slope * model_.d() * model_.tip().transpose();
    for (int c = 0; c < kStates; ++c) {
      if (k > 0) *out++ = -1;
      out = std::copy_n(by_state.data() + kStates * c, kStates, out);
    }
    out = std::copy_n(model_.b().data(), kStates, out);
  }
  std::fill_n(out, kStates, -1.0);
}

// sigma 2 diag(Q, R)  +  (lambda' D) f'' tip tip'
void Horizon::hessian(ConstVectorRef x, double sigma, ConstVectorRef lambda, Workspace&, std::span<double> values) const {
  double* out = values.data();
  const State q = 2 * sigma * weights_.state;
  for (int k = 0; k < intervals_; ++k) {
    const Derivatives f = rounded_wall_force(model_.parameters(), rounding_, model_.tip().dot(x.segment<kStates>(kStage * k)));
    const double w = lambda.segment<kStates>(kStates * k).dot(model_.d()) * f.curvature;
    *out++ = q[0] + w * model_.tip()[0] * model_.tip()[0];
    *out++ = w * model_.tip()[0] * model_.tip()[1];
    *out++ = q[1] + w * model_.tip()[1] * model_.tip()[1];
    *out++ = q[2];
    *out++ = q[3];
    *out++ = 2 * sigma * weights_.input;
  }
  for (int column = 0; column < kStates; ++column) {
    for (int row = column; row < kStates; ++row) *out++ = 2 * sigma * terminal_(row, column);
  }
}

std::string Horizon::variable_name(int i) const {
  static const char* const kNames[] = {"x", "theta", "v", "omega", "u"};
  return std::string(kNames[i % kStage]) + "[" + std::to_string(i / kStage) + "]";
}

}  // namespace tenon::soft_walls
