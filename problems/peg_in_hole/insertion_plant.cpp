#include "tenon/problems/peg_in_hole/insertion_plant.hpp"

#include <algorithm>
#include <cmath>

namespace tenon::peg {

namespace {

constexpr double kFirstTouch = 0.05;     // s: what counts as the first touch
constexpr std::size_t kSustained = 100;  // ms, over which a sustained force is the mean

constexpr std::array<const char*, 9> kVerdictNames{"hole_x",           "hole_z",          "hole_theta",    "success", "time",
                                                   "first_touch_peak", "sustained_force", "largest_force", "depth"};
constexpr std::array<const char*, 14> kOutputNames{"x",          "z",  "theta", "vx", "vz",    "omega",     "hole_x", "hole_z",
                                                   "hole_theta", "Fx", "Fz",    "My", "depth", "peak_force"};
constexpr std::array<const char*, 5> kContactOutputs{"gap_", "lambda_", "push_x_", "push_z_", "mode_"};
constexpr int kContactMode = 2;  // 0: free

}  // namespace

InsertionPlant::InsertionPlant(const World& world)
    : world_(world),
      damping_(2 * world.contact_damping_ratio * std::sqrt(1e-3 * world.contact_stiffness * world.mass[0])),
      window_(kSustained) {}

int InsertionPlant::num_commands() const {
  return kCommands;
}
int InsertionPlant::num_measurements() const {
  return kMeasurements;
}
std::string InsertionPlant::measurement_name(int i) const {
  return kMeasurementNames[static_cast<std::size_t>(i)];
}
std::string InsertionPlant::command_name(int i) const {
  return kCommandNames[static_cast<std::size_t>(i)];
}
double InsertionPlant::noise() {
  return surprises_ ? random_.normal() : 0;
}
double InsertionPlant::time() const {
  return kStep * static_cast<double>(steps_);
}

void InsertionPlant::reset(std::uint64_t seed) {
  random_ = Random(seed);
  surprises_ = seed != 0;
  hole_ = world_.prior.middle;
  if (surprises_) {
    for (int i = 0; i < 3; ++i) hole_[i] += world_.prior.half_width[i] * random_.uniform(-1, 1);
  }
  steps_ = 0;
  pending_.clear();
  pose_ = reference_ = world_.start;
  for (Vector3d* zero : {&rate_, &reference_rate_, &stiffness_}) zero->setZero();
  contacts_ = {};
  success_ = false;
  first_touch_ = -1;
  touched_ = {};
  time_ = first_touch_peak_ = tick_peak_ = largest_force_ = sustained_force_ = window_sum_ = millisecond_sum_ = 0;
  std::ranges::fill(window_, 0.0);
}

void InsertionPlant::act(ConstVectorRef commands) {
  const double lever = world_.geometry.lever;
  reference_ = to_millimetres(commands.segment<3>(kReference), lever);
  reference_rate_ = to_millimetres(commands.segment<3>(kReferenceRate), lever);
  stiffness_ = stiffness_to_millimetres(commands.segment<3>(kStiffness), lever);
}

void InsertionPlant::advance(double t_end, ConstVectorRef commands) {
  pending_.push_back({steps_ + std::lround(world_.delay / kStep), commands});
  tick_peak_ = 0;
  touched_ = {};
  const long end = std::lround(t_end / kStep);
  while (steps_ < end && !finished()) {
    for (; !pending_.empty() && pending_.front().step <= steps_; pending_.pop_front()) act(pending_.front().commands);
    step();
    reference_ += kStep * reference_rate_;
    ++steps_;
    judge();
  }
}

InsertionPlant::Contacts InsertionPlant::contacts(const Vector3d& pose, const Vector3d& rate) const {
  Contacts out;
  const std::array<ExactGap, kContacts> gaps = exact_gaps(world_.geometry, pose, hole_);
  for (std::size_t at = 0; at < gaps.size(); ++at) {
    const ExactGap& gap = gaps[at];
    out.gap[at] = gap.value;
    if (gap.value >= 0) continue;
    const double f = std::max(0.0, -world_.contact_stiffness * gap.value - damping_ * gap.normal.dot(rate));
    const double slip = gap.tangent.dot(rate);
    out.pressure[at] = f;
    const Vector3d push = f * (gap.normal - world_.friction * slip / std::hypot(slip, world_.friction_speed) * gap.tangent);
    out.pushes.col(static_cast<int>(at)) = push.head<2>();
    out.force += push;
  }
  return out;
}

void InsertionPlant::measure_motion(const Vector3d& seen_pose, const Vector3d& seen_rate, VectorRef values) const {
  const double lever = world_.geometry.lever;
  values.segment<3>(kMeasuredPose) = to_si(seen_pose, lever);
  values.segment<3>(kMeasuredVelocity) = to_si(seen_rate, lever);
  values.segment<3>(kMeasuredReference) = to_si(reference_, lever);
  values.segment<3>(kMeasuredRate) = to_si(reference_rate_, lever);
}

void InsertionPlant::judge() {
  const double force = contacts_.force.head<2>().norm();
  if (force > 0 && first_touch_ < 0) first_touch_ = steps_;
  largest_force_ = std::max(largest_force_, force);
  tick_peak_ = std::max(tick_peak_, force);
  for (std::size_t i = 0; i < kContacts; ++i) touched_[i] = touched_[i] || contacts_.pressure[i] > 0;
  if (first_touch_ >= 0 && kStep * static_cast<double>(steps_ - first_touch_) <= kFirstTouch)
    first_touch_peak_ = std::max(first_touch_peak_, force);

  millisecond_sum_ += force / kStepsPerSample;
  if (is_sample()) {
    double& oldest = window_[static_cast<std::size_t>(steps_ / kStepsPerSample) % kSustained];
    window_sum_ += millisecond_sum_ - oldest;
    oldest = millisecond_sum_;
    millisecond_sum_ = 0;
    sustained_force_ = std::max(sustained_force_, window_sum_ / kSustained);
    success_ = depth(world_.geometry, pose_, hole_) >= world_.success_depth;
    time_ = time();
  }
}

int InsertionPlant::num_outputs() const {
  return static_cast<int>(kOutputNames.size() + kContactOutputs.size() * kContacts);
}

std::string InsertionPlant::output_name(int i) const {
  const auto at = static_cast<std::size_t>(i);
  if (at < kOutputNames.size()) return kOutputNames[at];
  const std::size_t own = at - kOutputNames.size();
  return std::string(kContactOutputs[own / kContacts]) + kContactNames[own % kContacts];
}

void InsertionPlant::outputs(VectorRef values) const {
  const double lever = world_.geometry.lever;
  values.segment<3>(0) = to_si(pose_, lever);
  values.segment<3>(3) = to_si(rate_, lever);
  values.segment<3>(6) = to_si(hole_, lever);
  values.segment<3>(9) << contacts_.force.head<2>(), 1e-3 * lever * contacts_.force[2];
  values[12] = 1e-3 * depth(world_.geometry, pose_, hole_);
  values[13] = tick_peak_;
  auto each = values.segment(14, static_cast<int>(kContactOutputs.size()) * kContacts);
  for (int i = 0; i < kContacts; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const std::array<double, kContactOutputs.size()> of_contact{1e-3 * contacts_.gap[at], contacts_.pressure[at], contacts_.pushes(0, i),
                                                                contacts_.pushes(1, i), touched_[at] ? kContactMode : 0.0};
    for (std::size_t quantity = 0; quantity < of_contact.size(); ++quantity) each[static_cast<int>(quantity) * kContacts + i] = of_contact[quantity];
  }
}

int InsertionPlant::num_verdicts() const {
  return static_cast<int>(kVerdictNames.size());
}
std::string InsertionPlant::verdict_name(int i) const {
  return kVerdictNames[static_cast<std::size_t>(i)];
}
void InsertionPlant::verdicts(VectorRef values) const {
  values.segment<3>(0) = to_si(hole_, world_.geometry.lever);
  values.segment<6>(3) << (success_ ? 1 : 0), time_, first_touch_peak_, sustained_force_, largest_force_,
      1e-3 * depth(world_.geometry, pose_, hole_);
}

}  // namespace tenon::peg
