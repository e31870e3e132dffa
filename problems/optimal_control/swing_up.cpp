#include "tenon/problems/optimal_control/swing_up.hpp"

#include <stdexcept>
#include <utility>
#include <vector>

#include "tenon/problems/optimal_control/pole_on_cart.hpp"

namespace tenon {

namespace {

constexpr int kStates = 4, kStage = 5;  // x, and u behind it
constexpr int kLanes = 4;

/// The sweeps of all intervals, four by four; those beyond the last repeat it.
struct Sweeps final : Nlp::Scratch {
  explicit Sweeps(int intervals) : steps(static_cast<std::size_t>((intervals + kLanes - 1) / kLanes)) {}
  std::vector<RungeKuttaStep> steps;
};
std::vector<RungeKuttaStep>& steps_of(Nlp::Workspace& workspace) {
  return static_cast<Sweeps&>(*workspace).steps;
}

PoleOnCart pole_of(const SwingUpProgram& p) {
  return {p.cart_mass, p.pole_mass, p.length, p.gravity, p.zero_is_upright ? -1.0 : 1.0};
}

/// Intervals 4 g .. 4 g + 3 as far as there are so many.
int lanes_in_use(int intervals, std::size_t group) {
  return std::min(kLanes, intervals - kLanes * static_cast<int>(group));
}

}  // namespace

SwingUp::SwingUp(SwingUpProgram program) : program_(std::move(program)) {
  if (program_.intervals < 1)
    throw std::invalid_argument(program_.name + ": " + std::to_string(program_.intervals) + " intervals (expected at least 1)");
  if (!(program_.duration > 0))
    throw std::invalid_argument(program_.name + ": duration " + std::to_string(program_.duration) + " s (expected a positive one)");
}

Stages SwingUp::stages() const {
  Stages stages;
  for (int k = 0; k <= program_.intervals; ++k) {
    const bool last = k == program_.intervals;
    stages.stages.push_back({{kStage * k, kStage * k + (last ? kStates : kStage)}, {kStates * k, kStates * (k + (last ? 0 : 1))}});
  }
  return stages;
}

// Columns of an interval: position, angle, velocity, rate, force; each state but the first ones begins with the -1 of the row before.
//
//     position   1                     rows 0..3 of the interval
//     angle      *   *   *   *
//     velocity   h       1
//     rate       *   *   *   *
//     force      *   *   *   *
SparsePattern SwingUp::jacobian_pattern() const {
  std::vector<std::pair<int, int>> entries;
  for (int k = 0; k < program_.intervals; ++k) {
    const int row = kStates * k, column = kStage * k;
    entries.emplace_back(row, column);
    for (const int c : {1, 3, 4}) {
      for (int r = 0; r < kStates; ++r) entries.emplace_back(row + r, column + c);
    }
    for (const int r : {0, 2}) entries.emplace_back(row + r, column + 2);
    for (int r = 0; r < kStates; ++r) entries.emplace_back(row + r, column + kStage + r);
  }
  return SparsePattern::from_entries(num_constraints(), num_variables(), std::move(entries));
}

// Of a stage: the diagonal, and what couples angle, rate and force.
SparsePattern SwingUp::hessian_pattern() const {
  std::vector<std::pair<int, int>> entries;
  for (int i = 0; i < num_variables(); ++i) entries.emplace_back(i, i);
  for (int k = 0; k < program_.intervals; ++k) {
    const int first = kStage * k;
    entries.emplace_back(first + 3, first + 1);
    entries.emplace_back(first + 4, first + 1);
    entries.emplace_back(first + 4, first + 3);
  }
  return SparsePattern::from_entries(num_variables(), num_variables(), std::move(entries));
}

void SwingUp::bounds(Bounds& bounds) const {
  const int n = num_variables();
  for (int k = 0; k <= program_.intervals; ++k) {
    bounds.x_lower[kStage * k] = program_.least_position;
    bounds.x_upper[kStage * k] = program_.largest_position;
    if (k < program_.intervals) {
      bounds.x_lower[kStage * k + 4] = -program_.largest_input;
      bounds.x_upper[kStage * k + 4] = program_.largest_input;
    }
  }
  bounds.x_lower.head<kStates>() = bounds.x_upper.head<kStates>() = Eigen::Map<const Eigen::Vector4d>(program_.initial.data());
  if (program_.final) {
    bounds.x_lower.segment<kStates>(n - kStates) = bounds.x_upper.segment<kStates>(n - kStates) =
        Eigen::Map<const Eigen::Vector4d>(program_.final->data());
  }
  bounds.c_lower.setZero();
  bounds.c_upper.setZero();
}

void SwingUp::initial_point(VectorRef x) const {
  x.setZero();
  const SwingUpProgram::State& from = program_.initial;
  const SwingUpProgram::State& to = program_.final ? *program_.final : from;
  for (int k = 0; k <= program_.intervals; ++k) {
    const double t = static_cast<double>(k) / program_.intervals;
    for (int r = 0; r < 2; ++r) x[kStage * k + r] = (1 - t) * from[static_cast<std::size_t>(r)] + t * to[static_cast<std::size_t>(r)];
  }
}

Nlp::Workspace SwingUp::make_workspace() const {
  return std::make_unique<Sweeps>(program_.intervals);
}

void SwingUp::prepare(ConstVectorRef x, Workspace& workspace) const {
  const PoleOnCart pole = pole_of(program_);
  std::vector<RungeKuttaStep>& steps = steps_of(workspace);
  for (std::size_t g = 0; g < steps.size(); ++g) {
    Lane at[kStage];
    const int used = lanes_in_use(program_.intervals, g);
    for (int q = 0; q < kLanes; ++q) {
      const double* from = x.data() + kStage * (kLanes * static_cast<int>(g) + std::min(q, used - 1));
      for (int i = 0; i < kStage; ++i) at[i][q] = from[i];
    }
    steps[g].run(pole, step(), at[0], at[1], at[2], at[3], at[4]);
  }
}

double SwingUp::objective(ConstVectorRef x, Workspace&) const {
  const Eigen::Map<const Eigen::Array4d> weight(program_.state_weight.data()), final_weight(program_.final_weight.data());
  double sum = 0;
  for (int k = 0; k < program_.intervals; ++k) {
    const auto state = x.segment<kStates>(kStage * k).array();
    sum += (weight * state * state).sum() + program_.input_weight * x[kStage * k + 4] * x[kStage * k + 4];
  }
  const auto end = x.tail<kStates>().array();
  return 0.5 * (sum + (final_weight * end * end).sum());
}

void SwingUp::gradient(ConstVectorRef x, Workspace&, VectorRef gradient) const {
  const Eigen::Map<const Eigen::Array4d> weight(program_.state_weight.data()), final_weight(program_.final_weight.data());
  for (int k = 0; k < program_.intervals; ++k) {
    gradient.segment<kStates>(kStage * k) = (weight * x.segment<kStates>(kStage * k).array()).matrix();
    gradient[kStage * k + 4] = program_.input_weight * x[kStage * k + 4];
  }
  gradient.tail<kStates>() = (final_weight * x.tail<kStates>().array()).matrix();
}

void SwingUp::constraints(ConstVectorRef x, Workspace& workspace, VectorRef values) const {
  const std::vector<RungeKuttaStep>& steps = steps_of(workspace);
  for (int k = 0; k < program_.intervals; ++k) {
    const RungeKuttaStep& step = steps[static_cast<std::size_t>(k / kLanes)];
    for (int r = 0; r < kStates; ++r) values[kStates * k + r] = step.end[r][k % kLanes] - x[kStage * (k + 1) + r];
  }
}

void SwingUp::jacobian(ConstVectorRef, Workspace& workspace, std::span<double> values) const {
  const std::vector<RungeKuttaStep>& steps = steps_of(workspace);
  const double h = step();
  double* out = values.data();
  for (int k = 0; k < program_.intervals; ++k) {
    const RungeKuttaStep& step = steps[static_cast<std::size_t>(k / kLanes)];
    const int q = k % kLanes;
    const auto defect_before = [&] {
      if (k > 0) *out++ = -1;
    };
    const auto column = [&](int d) {
      for (int r = 0; r < kStates; ++r) *out++ = step.d_end[r][d][q];
    };
    defect_before(), *out++ = 1;
    defect_before(), column(0);
    defect_before(), *out++ = h, *out++ = 1;
    defect_before(), column(1);
    column(2);
  }
  for (int r = 0; r < kStates; ++r) *out++ = -1;
}

void SwingUp::hessian(ConstVectorRef, double sigma, ConstVectorRef lambda, Workspace& workspace, std::span<double> values) const {
  const PoleOnCart pole = pole_of(program_);
  const std::vector<RungeKuttaStep>& steps = steps_of(workspace);
  const SwingUpProgram::State& weight = program_.state_weight;
  double* out = values.data();
  for (std::size_t g = 0; g < steps.size(); ++g) {
    const int used = lanes_in_use(program_.intervals, g);
    Lane curvature[6];
    if (program_.gauss_newton) {
      for (Lane& entry : curvature) entry.setZero();
    } else {
      Lane multiplier[kStates];
      for (int q = 0; q < kLanes; ++q) {
        const double* from = lambda.data() + kStates * (kLanes * static_cast<int>(g) + std::min(q, used - 1));
        for (int r = 0; r < kStates; ++r) multiplier[r][q] = from[r];
      }
      steps[g].hessian(pole, step(), multiplier, curvature);
    }
    for (int q = 0; q < used; ++q, out += 8) {
      out[0] = sigma * weight[0];
      out[1] = sigma * weight[1] + curvature[0][q];
      out[2] = curvature[1][q];
      out[3] = curvature[2][q];
      out[4] = sigma * weight[2];
      out[5] = sigma * weight[3] + curvature[3][q];
      out[6] = curvature[4][q];
      out[7] = sigma * program_.input_weight + curvature[5][q];
    }
  }
  for (const double final_weight : program_.final_weight) *out++ = sigma * final_weight;
}

std::string SwingUp::variable_name(int i) const {
  constexpr const char* kNames[] = {"position", "angle", "velocity", "angular_velocity", "force"};
  return std::string(kNames[i % kStage]) + "[" + std::to_string(i / kStage) + "]";
}

std::string SwingUp::constraint_name(int j) const {
  constexpr const char* kNames[] = {"position", "angle", "velocity", "angular_velocity"};
  return std::string("defect_") + kNames[j % kStates] + "[" + std::to_string(j / kStates) + "]";
}

SwingUpProgram cart_pole(int intervals) {
  return {.name = "cart-pole",
          .cart_mass = 5,
          .pole_mass = 0.5,
          .length = 0.5,
          .gravity = 9.806,
          .duration = 5,
          .intervals = intervals,
          .input_weight = 2,
          .largest_input = 20,
          .least_position = 0,
          .largest_position = 2,
          .final = SwingUpProgram::State{1, 3.14159265358979323846, 0, 0}};
}

SwingUpProgram pendulum(int intervals) {
  const double h = 1.0 / intervals;
  return {.name = "pendulum",
          .cart_mass = 1,
          .pole_mass = 0.1,
          .length = 0.8,
          .gravity = 9.81,
          .zero_is_upright = true,
          .duration = 1,
          .intervals = intervals,
          .state_weight = {h * 2e3, h * 2e3, h * 2e-2, h * 2e-2},
          .final_weight = {2e3, 2e3, 2e-2, 2e-2},
          .input_weight = h * 2e-2,
          .largest_input = 80,
          .initial = {0, 3.14159265358979323846, 0, 0}};
}

}  // namespace tenon
