#include "tenon/problems/peg_in_hole/assembly_program.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "tenon/problems/peg_in_hole/channels.hpp"

namespace tenon::peg {

namespace {

constexpr double kLateralShare = 0.5;  // of the largest rate: how fast the initial point goes to the hole's axis
constexpr double kProgress = 0.5, kPatience = 0.15;  // mm, s: less than so much in so long is a jam
constexpr double kSurprise = 0.3;  // mm: a hole that moves further between two ticks has a plan of its own (peg_in_hole.md, section 2)

}  // namespace

AssemblyProgram::AssemblyProgram(const AssemblyProblem& problem) : problem_(problem) {
  if (problem_.intervals < 1)
    throw std::invalid_argument(problem_.name + ": " + std::to_string(problem_.intervals) + " intervals (expected at least 1)");
  if (!(problem_.interval > 0))
    throw std::invalid_argument(problem_.name + ": an interval of " + std::to_string(problem_.interval) + " s (expected a positive one)");
  step_ = kUnitOfRate * problem_.interval;
  inertia_ = 1e-3 * kUnitOfRate / problem_.interval * problem_.impedance.mass;
  const Vector3d damping = kUnitOfRate / step_ * problem_.impedance.damping();  // D / dt
  yield_ = (problem_.impedance.stiffness + damping).cwiseInverse();
  keep_ = damping.cwiseProduct(yield_);
  pose_ = problem_.pose;
  hole_ = problem_.hole;
  lateral_ = problem_.follow_hole ? hole_ : pose_;
  velocity_.setZero(), spring_.setZero(), rate_.setZero();
}

int AssemblyProgram::num_measurements() const {
  return kMeasurements;
}
int AssemblyProgram::num_commands() const {
  return kCommands;
}

void AssemblyProgram::observe(double t, ConstVectorRef measurements, ConstVectorRef estimates) {
  const double lever = problem_.geometry.lever;
  pose_ = to_millimetres(measurements.segment<3>(kMeasuredPose), lever);
  velocity_ = to_millimetres(measurements.segment<3>(kMeasuredVelocity), lever) / kUnitOfRate;
  spring_ = to_millimetres(measurements.segment<3>(kMeasuredReference), lever) - pose_;
  rate_ = to_millimetres(measurements.segment<3>(kMeasuredRate), lever) / kUnitOfRate;
  const Vector3d believed = hole_;
  hole_ = to_millimetres(estimates, lever);
  hole_has_moved_ = t > progress_time_ && (hole_ - believed).lpNorm<Eigen::Infinity>() > kSurprise;
  if (problem_.follow_hole) lateral_ = hole_;
  watch_progress(t);
}

void AssemblyProgram::watch_progress(double t) {
  const bool again = t <= progress_time_, moves = std::abs(pose_[1] - progress_height_) > kProgress;
  is_jammed_ = !again && !moves && t - progress_time_ > kPatience;
  if (again || moves || is_jammed_) progress_height_ = pose_[1], progress_time_ = t;
}

Stages AssemblyProgram::stages() const {
  Stages stages;
  for (int k = 0; k < problem_.intervals; ++k) {
    stages.stages.push_back({{kStage * k, kStage * (k + 1)}, {kRows * k, kRows * (k + 1)}});
  }
  stages.stages.push_back({{kStage * problem_.intervals, num_variables()}, {num_constraints(), num_constraints()}});
  return stages;
}

// Columns of an interval; a state begins with the -1 of the interval before.
//
//               pose  rate  spring  reference's rate  gaps  products
//     q    1     I           -bW         -bW/c         g'    lambda g'
//     v    1                 -bm         -bm/c
//     e    1                  a          (a-1)/c
//     u    1
//     w         c I    I    b(m-cW)    1+b(m/c-W)     c g'  c lambda g'
//     lambda                 -b g        -b g/c              h_i
SparsePattern AssemblyProgram::jacobian_pattern() const {
  SparsePattern pattern{num_constraints(), num_variables(), {0}, {}};
  for (int i = 0; i < num_variables(); ++i) {
    const int k = i / kStage, c = i % kStage, axis = c % 3, row = kRows * k;
    const auto add = [&](int first, int count) {
      for (int r = first; r < first + count; ++r) pattern.inner.push_back(row + r);
    };
    if (k > 0 && c < kStates) pattern.inner.push_back(row - kRows + c);
    if (k < problem_.intervals) {
      if (c < kVelocity) add(kPose + axis, 1), add(kSpring, 6), add(kGaps, 12);
      else if (c < kRate) add(kSpring + axis, 1), add(kRate + axis, 1);
      else if (c < kNext) {}
      else if (c < kForces) add(kPose + axis, 1), add(kVelocity + axis, 1), add(kSpring, 6), add(kGaps, 12);
      else add(kSpring, 6), add(kProducts + c - kForces, 1);
    }
    pattern.outer.push_back(pattern.nonzeros());
  }
  return pattern;
}

SparsePattern AssemblyProgram::hessian_pattern() const {
  SparsePattern pattern{num_variables(), num_variables(), {0}, {}};
  for (int i = 0; i < num_variables(); ++i) {
    const int k = i / kStage;
    const int end = k < problem_.intervals ? kStage * (k + 1) : i + 1;
    for (int r = i; r < end; ++r) pattern.inner.push_back(r);
    pattern.outer.push_back(pattern.nonzeros());
  }
  return pattern;
}

void AssemblyProgram::bounds(Bounds& bounds) const {
  // what is beyond a limit now may stay there, so that there is always a plan
  const Vector3d stiffness = problem_.impedance.stiffness;
  const Eigen::Array2d spring = (problem_.largest_spring / stiffness.head<2>().array()).max(spring_.head<2>().array().abs());
  const double rate = problem_.largest_rate / kUnitOfRate;
  for (int k = 0; k <= problem_.intervals; ++k) {
    const int first = kStage * k;
    bounds.x_lower.segment<2>(first + kSpring) = -spring;
    bounds.x_upper.segment<2>(first + kSpring) = spring;
    bounds.x_lower.segment<3>(first + kRate).setConstant(-rate);
    bounds.x_upper.segment<3>(first + kRate).setConstant(rate);
    if (k == problem_.intervals) break;
    bounds.x_lower.segment<kContacts>(first + kForces).setZero();
    bounds.x_upper.segment<kContacts>(first + kForces).setConstant(problem_.largest_force);
    bounds.c_lower.segment<kGaps>(kRows * k).setZero();
    bounds.c_upper.segment<kGaps>(kRows * k).setZero();
    bounds.c_lower.segment<kContacts>(kRows * k + kGaps).setZero();
    bounds.c_upper.segment<kContacts>(kRows * k + kProducts).setConstant(problem_.complementarity);
  }
  Eigen::Matrix<double, kStates, 1> now;
  now << pose_, velocity_, spring_, rate_;
  bounds.x_lower.head<kStates>() = bounds.x_upper.head<kStates>() = now;
}

double AssemblyProgram::wanted_height(int k) const {
  return std::max(pose_[1] - problem_.speed * problem_.interval * k, hole_[1] - problem_.depth);
}

void AssemblyProgram::initial_point(VectorRef x) const {
  x.setZero();
  Vector3d pose = pose_, velocity = velocity_, spring = spring_, rate = rate_;
  for (int k = 0;; ++k) {
    x.segment<kStates>(kStage * k) << pose, velocity, spring, rate;
    if (k == problem_.intervals) break;
    const Vector3d next = next_on_the_way(pose), end_rate = (next - pose) / step_;
    const Vector3d force = inertia_.cwiseProduct(end_rate - velocity);                                      // (2.2) without contact
    const Vector3d end_spring = keep_.cwiseProduct(spring) + yield_.cwiseProduct(force);                    // (2.3)
    x.segment<3>(kStage * k + kNext) = end_rate;
    x.segment<kContacts>(kStage * k + kForces).setConstant(problem_.guessed_force);
    rate = (end_spring - spring) / step_ + end_rate;                                                        // (2.4)
    pose = next, velocity = end_rate, spring = end_spring;
  }
}

Vector3d AssemblyProgram::next_on_the_way(const Vector3d& pose) const {
  const double reach = kLateralShare * problem_.largest_rate * problem_.interval;
  Vector3d next = pose;
  bool is_above_hole = true;
  for (const int axis : {0, 2}) {
    const double away = lateral_[axis] - pose[axis];
    next[axis] += std::clamp(away, -reach, reach);
    is_above_hole = is_above_hole && std::abs(away) <= reach;
  }
  const Vector3d lower(next[0], std::max(pose[1] - problem_.speed * problem_.interval, hole_[1] - problem_.depth), next[2]);
  const auto gaps = exact_gaps(problem_.geometry, lower, hole_);
  const bool is_free = std::ranges::all_of(gaps, [](const ExactGap& gap) { return gap.value >= 0; });
  return is_above_hole || is_free ? lower : next;
}

std::string AssemblyProgram::variable_name(int i) const {
  constexpr const char* kNames[] = {"x",        "z",        "phi",    "vx",     "vz",     "vphi",   "spring_x", "spring_z",
                                    "spring_phi", "rate_x", "rate_z", "rate_phi", "next_vx", "next_vz", "next_vphi"};
  const int c = i % kStage;
  const std::string name = c < kForces ? kNames[c] : std::string("lambda_") + kContactNames[static_cast<std::size_t>(c - kForces)];
  return name + "[" + std::to_string(i / kStage) + "]";
}

std::string AssemblyProgram::constraint_name(int j) const {
  const int r = j % kRows, k = j / kRows;
  if (r < kStates) return "defect_" + variable_name(kStage * k + r);
  return (r < kProducts ? "gap_" : "product_") + std::string(kContactNames[static_cast<std::size_t>((r - kGaps) % kContacts)]) + "[" +
         std::to_string(k) + "]";
}

AssemblyProblem single_plan() {
  AssemblyProblem problem;
  problem.interval = 0.03;
  problem.intervals = 40;
  problem.smoothing = 0.05;  // differences can still follow its third derivative
  problem.follow_hole = false;
  problem.guessed_force = 0.1;
  problem.hole = {0.9, 0, std::numbers::pi / 180 * problem.geometry.lever};
  return problem;
}

}  // namespace tenon::peg
