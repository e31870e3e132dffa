// What a plan of AssemblyProgram says to others, in SI: commands, what it foresees, its trajectory.
#include <algorithm>

#include "tenon/problems/peg_in_hole/assembly_program.hpp"
#include "tenon/problems/peg_in_hole/channels.hpp"

namespace tenon::peg {

namespace {

constexpr double kPressing = 0.1;  // N: what pushes harder is in contact; by (2.5) its gap is then below 0.1 mm

void append(std::vector<std::string>& columns, const std::string& prefix, const auto& names) {
  for (const char* name : names) columns.push_back(prefix + name);
}

}  // namespace

std::string AssemblyProgram::command_name(int i) const {
  return kCommandNames[static_cast<std::size_t>(i)];
}

void AssemblyProgram::commands(const Point& plan, double elapsed, VectorRef commands) const {
  const double place = std::clamp(elapsed / problem_.interval, 0.0, static_cast<double>(problem_.intervals));
  const int k = std::min(static_cast<int>(place), problem_.intervals - 1);
  const auto reference = [&](int stage) -> Vector3d {
    return plan.x.segment<3>(kStage * stage + kPose) + plan.x.segment<3>(kStage * stage + kSpring);
  };
  const Vector3d from = reference(k), to = reference(k + 1);
  const Vector3d rate = place < problem_.intervals ? Vector3d((to - from) / problem_.interval) : Vector3d::Zero();
  const double lever = problem_.geometry.lever;
  commands.segment<3>(kReference) = to_si(from + (place - k) * (to - from), lever);
  commands.segment<3>(kReferenceRate) = to_si(rate, lever);
  commands.segment<3>(kStiffness) = stiffness_to_si(problem_.impedance.stiffness, lever);
}

std::string AssemblyProgram::plan_output_name(int i) const {
  constexpr std::array<const char*, 3> kNames{"plan_x", "plan_z", "plan_theta"};
  return kNames[static_cast<std::size_t>(i / problem_.intervals)] + std::to_string(i % problem_.intervals + 1);
}

void AssemblyProgram::plan_outputs(const Point& plan, VectorRef values) const {
  for (int k = 0; k < problem_.intervals; ++k) {
    const Vector3d pose = to_si(plan.x.segment<3>(kStage * (k + 1) + kPose), problem_.geometry.lever);
    for (int axis = 0; axis < 3; ++axis) values[axis * problem_.intervals + k] = pose[axis];
  }
}

std::vector<std::string> AssemblyProgram::trajectory_columns() const {
  std::vector<std::string> columns{"x", "z", "theta", "vx", "vz", "omega", "hole_x", "hole_z", "hole_theta"};
  for (int i = 0; i < kStiffness; ++i) columns.push_back(command_name(i));
  for (const char* prefix : {"gap_", "lambda_", "mode_", "push_x_", "push_z_"}) append(columns, prefix, kContactNames);
  append(columns, "", std::array{"Fx", "Fz", "depth", "energy"});
  return columns;
}

// Contacts act at the end of an interval, so that an instant has the forces of the interval before it; at the start there are none.
void AssemblyProgram::trajectory(const Point& plan, int k, VectorRef values) const {
  const double lever = problem_.geometry.lever;
  const double* stage = plan.x.data() + kStage * k;
  const Eigen::Map<const Vector3d> pose(stage + kPose), velocity(stage + kVelocity), spring(stage + kSpring), rate(stage + kRate);
  const Vector3d reference = pose + spring;
  double* out = values.data();
  for (const Vector3d& each : {to_si(pose, lever), to_si(kUnitOfRate * velocity, lever), to_si(hole_, lever), to_si(reference, lever),
                               to_si(kUnitOfRate * rate, lever)}) {
    out = std::ranges::copy(each, out).out;
  }
  const auto gaps = smooth_gaps(problem_.geometry, problem_.smoothing, pose, hole_);
  Vector2d force(0, 0);
  for (int i = 0; i < kContacts; ++i, ++out) {
    const Jet& gap = gaps[static_cast<std::size_t>(i)];
    const double lambda = k > 0 ? stage[kForces + i - kStage] : 0;
    const Vector2d push = lambda * gap.gradient.head<2>();
    force += push;
    const std::array<double, 5> of_contact{kMillimetre * gap.value, lambda, lambda > kPressing ? 2.0 : 0.0, push[0], push[1]};
    for (int row = 0; row < 5; ++row) out[kContacts * row] = of_contact[static_cast<std::size_t>(row)];
  }
  out += 4 * kContacts;
  // E = (v' M v + e' K e)/2
  const double kinetic = (kMillimetre * kUnitOfRate * velocity).cwiseAbs2().dot(problem_.impedance.mass) / 2;
  const double elastic = kMillimetre * spring.cwiseAbs2().dot(problem_.impedance.stiffness) / 2;
  std::ranges::copy(std::array{force[0], force[1], kMillimetre * depth(problem_.geometry, pose, hole_), kinetic + elastic}, out);
}

}  // namespace tenon::peg
