#include "tenon/problems/touch_down/horizon.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace tenon::touch_down {

namespace {

// cm and dm/s of a metre and a metre per second
constexpr double kLength = 100, kSpeed = 10;
constexpr double kTerminalPosition = 1, kTerminalSpeed = 0.1;
constexpr double kLittleForce = 0.5;  // N
constexpr double kPressing = 0.1;     // N: contact, of a trajectory

enum Variable { kZ, kV, kBefore, kW, kLambda };
enum ContactRow { kBarrier = 3, kForceBarrier, kForceGap, kForceNextGap };

}  // namespace

Horizon::Horizon(const Parameters& parameters, double start, double plane)
    : parameters_(parameters), dt_(parameters.step), plane_(kLength * plane) {
  if (parameters.intervals < 1) throw std::invalid_argument("a horizon of " + std::to_string(parameters.intervals) + " intervals (expected at least 1)");
  start_[kZ] = kLength * start;
}

void Horizon::observe(double, ConstVectorRef measurements, ConstVectorRef estimates) {
  start_ = {kLength * measurements[0], kSpeed * measurements[1], measurements[4]};
  plane_ = kLength * estimates[0];
  force_ = estimates[1];
}

void Horizon::commands(const Point& plan, double elapsed, VectorRef commands) const {
  const int k = std::clamp(static_cast<int>(elapsed / dt_ + 1e-6), 0, parameters_.intervals - 1);
  commands[0] = plan.x[kStage * k + kW];
}

std::string Horizon::plan_output_name(int i) const {
  const int n = parameters_.intervals;
  return (i < n ? "plan_z" : "plan_force") + std::to_string(i % n + 1);
}

void Horizon::plan_outputs(const Point& plan, VectorRef values) const {
  const int n = parameters_.intervals;
  for (int k = 0; k < n; ++k) {
    values[k] = plan.x[kStage * (k + 1) + kZ] / kLength;
    values[n + k] = plan.x[kStage * k + kLambda];
  }
}

std::vector<std::string> Horizon::trajectory_columns() const {
  return {"z", "v", "plane", "gap_plane", "lambda_plane", "mode_plane", "w", "energy"};
}

void Horizon::trajectory(const Point& plan, int k, VectorRef values) const {
  const auto state = plan.x.segment<kStates>(kStage * k), decided = plan.x.segment<kStates>(kStage * std::min(k, parameters_.intervals - 1) + kW);
  const double z = state[kZ] / kLength, v = state[kV] / kSpeed, plane = plane_ / kLength, force = decided[kLambda - kW];
  values << z, v, plane, plane - z, force, force > kPressing ? 2 : 0, decided[0], parameters_.mass * v * v / 2;
}

Stages Horizon::stages() const {
  Stages stages;
  for (int k = 0; k <= parameters_.intervals; ++k) {
    const bool last = k == parameters_.intervals;
    stages.stages.push_back({{kStage * k, kStage * k + (last ? kStates : kStage)}, {kRows * k, kRows * (k + (last ? 0 : 1))}});
  }
  return stages;
}

// r = z_p + row w_k:   h' = -v,  h'' = -w + lambda/m
Horizon::Row Horizon::barrier_row() const {
  const double p = parameters_.pole, acceleration = kLength / (p * p);
  return {-1, -2 / p * kLength / kSpeed, 0, -acceleration, acceleration / parameters_.mass};
}

// h_{k+1} = z_p + row w_k:   z+ = z + dt v + dt^2/2 (w - lambda/m)
Horizon::Row Horizon::next_gap_row() const {
  const double half = dt_ * dt_ / 2 * kLength;
  return {-1, -dt_ * kLength / kSpeed, 0, -half, half / parameters_.mass};
}

// Rows of an interval:
//
//                       z_k  v_k  w_{k-1}  w_k  lambda_k     z+  v+  w
//     z+                 1    *             *     *          -1
//     v+                      1             *     *              -1
//     w                                     1                        -1
//     r                  *    *             *     *
//     lambda r           *    *             *     *
//     lambda h           *                        *
//     lambda h+          *    *             *     *
SparsePattern Horizon::jacobian_pattern() const {
  std::vector<std::pair<int, int>> entries;
  for (int k = 0; k < parameters_.intervals; ++k) {
    const int row = kRows * k, column = kStage * k;
    for (const int c : {kZ, kV, kW, kLambda}) {
      if (c != kV && c != kZ) entries.emplace_back(row + 1, column + c);
      entries.emplace_back(row, column + c);
      for (const int r : {kBarrier, kForceBarrier, kForceNextGap}) entries.emplace_back(row + r, column + c);
    }
    entries.emplace_back(row + 1, column + kV);
    entries.emplace_back(row + 2, column + kW);
    for (const int c : {kZ, kLambda}) entries.emplace_back(row + kForceGap, column + c);
    for (int r = 0; r < kDynamics; ++r) entries.emplace_back(row + r, column + kStage + r);
  }
  return SparsePattern::from_entries(num_constraints(), num_variables(), std::move(entries));
}

// Of a stage: the diagonal, w with the w before, lambda with all that moves a gap.
SparsePattern Horizon::hessian_pattern() const {
  std::vector<std::pair<int, int>> entries;
  for (int i = 0; i < num_variables(); ++i) entries.emplace_back(i, i);
  for (int k = 0; k < parameters_.intervals; ++k) {
    const int first = kStage * k;
    entries.emplace_back(first + kW, first + kBefore);
    for (const int c : {kZ, kV, kW}) entries.emplace_back(first + kLambda, first + c);
  }
  return SparsePattern::from_entries(num_variables(), num_variables(), std::move(entries));
}

void Horizon::bounds(Bounds& bounds) const {
  const Parameters& p = parameters_;
  const double slack = p.slack * kLength;
  for (int k = 0; k < p.intervals; ++k) {
    bounds.x_lower[kStage * k + kW] = -p.largest_input;
    bounds.x_upper[kStage * k + kW] = p.largest_input;
    bounds.x_lower[kStage * k + kLambda] = 0;
    bounds.x_upper[kStage * k + kLambda] = p.largest_force;
    bounds.c_lower.segment<kDynamics>(kRows * k).setZero();
    bounds.c_upper.segment<kDynamics>(kRows * k).setZero();
    bounds.c_lower[kRows * k + kBarrier] = 0;
    bounds.c_upper[kRows * k + kForceBarrier] = slack;
    if (p.contact == Parameters::Contact::pair) continue;
    bounds.c_upper[kRows * k + kForceGap] = slack;
    bounds.c_upper[kRows * k + kForceNextGap] = slack;
  }
  bounds.x_lower.head<kStates>() = bounds.x_upper.head<kStates>() = start_;
}

void Horizon::initial_point(VectorRef x) const {
  x.setZero();
  for (int k = 0; k <= parameters_.intervals; ++k) {
    const double t = static_cast<double>(k) / parameters_.intervals;
    x[kStage * k + kZ] = (1 - t) * start_[kZ] + t * plane_;
    if (k < parameters_.intervals) x[kStage * k + kLambda] = kLittleForce;
  }
  x.head<kStates>() = start_;
}

double Horizon::objective(ConstVectorRef x, Workspace&) const {
  const Parameters& p = parameters_;
  double sum = 0;
  for (int k = 0; k < p.intervals; ++k) {
    const auto at = x.segment<kStage>(kStage * k);
    const double away = at[kZ] - plane_, input = at[kW] - force_ / p.mass, change = at[kW] - at[kBefore], force = at[kLambda] - force_;
    sum += dt_ * (away * away + p.input_weight * input * input + p.force_weight * force * force) + p.change_weight * change * change;
  }
  const auto end = x.tail<kStates>();
  return sum + kTerminalPosition * (end[kZ] - plane_) * (end[kZ] - plane_) + kTerminalSpeed * end[kV] * end[kV];
}

void Horizon::gradient(ConstVectorRef x, Workspace&, VectorRef gradient) const {
  const Parameters& p = parameters_;
  for (int k = 0; k < p.intervals; ++k) {
    const auto at = x.segment<kStage>(kStage * k);
    const double change = 2 * p.change_weight * (at[kW] - at[kBefore]);
    gradient.segment<kStage>(kStage * k) << 2 * dt_ * (at[kZ] - plane_), 0, -change,
        2 * dt_ * p.input_weight * (at[kW] - force_ / p.mass) + change, 2 * dt_ * p.force_weight * (at[kLambda] - force_);
  }
  const auto end = x.tail<kStates>();
  gradient.tail<kStates>() << 2 * kTerminalPosition * (end[kZ] - plane_), 2 * kTerminalSpeed * end[kV], 0;
}

void Horizon::constraints(ConstVectorRef x, Workspace&, VectorRef values) const {
  const Row barrier = barrier_row(), next_gap = next_gap_row();
  for (int k = 0; k < parameters_.intervals; ++k) {
    const Eigen::Matrix<double, kStage, 1> at = x.segment<kStage>(kStage * k);
    const auto next = x.segment<kStates>(kStage * (k + 1));
    const double r = plane_ + barrier.dot(at), h_next = plane_ + next_gap.dot(at);
    values.segment<kRows>(kRows * k) << -next_gap.dot(at) - next[kZ],
        at[kV] + kSpeed * dt_ * (at[kW] - at[kLambda] / parameters_.mass) - next[kV],
        at[kW] - next[kBefore], r, at[kLambda] * r, at[kLambda] * (plane_ - at[kZ]), at[kLambda] * h_next;
  }
}

void Horizon::jacobian(ConstVectorRef x, Workspace&, std::span<double> values) const {
  const Row barrier = barrier_row(), next_gap = next_gap_row();
  const double speed = kSpeed * dt_;
  double* out = values.data();
  for (int k = 0; k < parameters_.intervals; ++k) {
    const Eigen::Matrix<double, kStage, 1> at = x.segment<kStage>(kStage * k);
    const double force = at[kLambda], r = plane_ + barrier.dot(at), h_next = plane_ + next_gap.dot(at);
    const double moved[] = {-next_gap[kZ], -next_gap[kV], 0, -next_gap[kW], -next_gap[kLambda]};
    // z
    if (k > 0) *out++ = -1;
    out = std::ranges::copy(std::array{moved[kZ], barrier[kZ], force * barrier[kZ], -force, force * next_gap[kZ]}, out).out;
    // v
    if (k > 0) *out++ = -1;
    out = std::ranges::copy(std::array{moved[kV], 1.0, barrier[kV], force * barrier[kV], force * next_gap[kV]}, out).out;
    // w before
    if (k > 0) *out++ = -1;
    // w
    out = std::ranges::copy(std::array{moved[kW], speed, 1.0, barrier[kW], force * barrier[kW], force * next_gap[kW]}, out).out;
    // lambda
    out = std::ranges::copy(std::array{moved[kLambda], -speed / parameters_.mass, barrier[kLambda], r + force * barrier[kLambda],
                                       plane_ - at[kZ], h_next + force * next_gap[kLambda]},
                            out).out;
  }
  std::fill_n(out, kStates, -1.0);
}

void Horizon::hessian(ConstVectorRef, double sigma, ConstVectorRef lambda, Workspace&, std::span<double> values) const {
  const Parameters& p = parameters_;
  const Row barrier = barrier_row(), next_gap = next_gap_row();
  double* out = values.data();
  for (int k = 0; k < p.intervals; ++k) {
    const double* multiplier = lambda.data() + kRows * k;
    const Row product = multiplier[kForceBarrier] * barrier + multiplier[kForceNextGap] * next_gap;
    *out++ = 2 * sigma * dt_;                                    // z z
    *out++ = product[kZ] - multiplier[kForceGap];                // lambda z
    *out++ = 0;                                                  // v v
    *out++ = product[kV];                                        // lambda v
    *out++ = 2 * sigma * p.change_weight;                        // before before
    *out++ = -2 * sigma * p.change_weight;                       // w before
    *out++ = 2 * sigma * (dt_ * p.input_weight + p.change_weight);  // w w
    *out++ = product[kW];                                        // lambda w
    *out++ = 2 * sigma * dt_ * p.force_weight + 2 * product[kLambda];  // lambda lambda
  }
  *out++ = 2 * sigma * kTerminalPosition;
  *out++ = 2 * sigma * kTerminalSpeed;
  *out++ = 0;
}

std::string Horizon::variable_name(int i) const {
  static const char* const kNames[] = {"z", "v", "w_before", "w", "lambda"};
  return std::string(kNames[i % kStage]) + "[" + std::to_string(i / kStage) + "]";
}

std::string Horizon::constraint_name(int j) const {
  static const char* const kNames[] = {"z_next", "v_next", "w_kept", "barrier", "force_barrier", "force_gap", "force_next_gap"};
  return std::string(kNames[j % kRows]) + "[" + std::to_string(j / kRows) + "]";
}

}  // namespace tenon::touch_down
