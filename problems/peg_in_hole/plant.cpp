#include "tenon/problems/peg_in_hole/plant.hpp"

#include <algorithm>
#include <cmath>

#include "tenon/problems/peg_in_hole/channels.hpp"

namespace tenon::peg {

namespace {

constexpr double kStep = 2e-5;             // s
constexpr long kStepsPerSample = 50;       // of the inner loop
constexpr double kRateFilter = 2e-3;       // s, of the differences of encoder readings
constexpr double kFirstTouch = 0.05;       // s: what counts as the first touch
constexpr std::size_t kSustained = 100;    // ms, over which a sustained force is the mean

constexpr std::array<const char*, 9> kVerdictNames{"hole_x",           "hole_z",          "hole_theta",    "success", "time",
                                                   "first_touch_peak", "sustained_force", "largest_force", "depth"};
constexpr std::array<const char*, 16> kOutputNames{"x",      "z",      "theta",        "vx",          "vz",          "omega",
                                                   "hole_x", "hole_z", "hole_theta",   "reference_x", "reference_z", "reference_theta",
                                                   "Fx",     "Fz",     "My",           "depth"};

}  // namespace

PegPlant::PegPlant(const World& world)
    : world_(world),
      damping_(2 * world.contact_damping_ratio * std::sqrt(1e-3 * world.contact_stiffness * world.mass[0])),
      window_(kSustained) {
  reset(0);
}

int PegPlant::num_commands() const {
  return kCommands;
}
int PegPlant::num_measurements() const {
  return kMeasurements;
}
std::string PegPlant::measurement_name(int i) const {
  return kMeasurementNames[static_cast<std::size_t>(i)];
}
std::string PegPlant::command_name(int i) const {
  return kCommandNames[static_cast<std::size_t>(i)];
}
double PegPlant::time() const {
  return kStep * static_cast<double>(steps_);
}

void PegPlant::reset(std::uint64_t seed) {
  random_.seed(seed);
  normal_.reset();
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int i = 0; i < 3; ++i) hole_[i] = world_.prior.middle[i] + world_.prior.half_width[i] * uniform(random_);
  steps_ = 0;
  pose_ = reference_ = seen_pose_ = world_.start;
  for (Vector3d* zero : {&rate_, &reference_rate_, &stiffness_, &seen_rate_, &drive_, &contact_force_, &filtered_force_}) zero->setZero();
  success_ = false;
  first_touch_ = -1;
  time_ = first_touch_peak_ = largest_force_ = sustained_force_ = window_sum_ = millisecond_sum_ = 0;
  std::ranges::fill(window_, 0.0);
}

void PegPlant::advance(double t_end, ConstVectorRef commands) {
  const double lever = world_.geometry.lever;
  reference_ = to_millimetres(commands.segment<3>(kReference), lever);
  reference_rate_ = to_millimetres(commands.segment<3>(kReferenceRate), lever);
  stiffness_ = stiffness_to_millimetres(commands.segment<3>(kStiffness), lever);
  const Vector3d damping = Impedance{world_.mass, stiffness_}.damping();
  const long end = std::lround(t_end / kStep);
  while (steps_ < end && !success_) step(damping);
}

void PegPlant::sample_encoders() {
  constexpr double kPeriod = kStep * kStepsPerSample;
  const Vector3d before = seen_pose_;
  for (int i = 0; i < 3; ++i) seen_pose_[i] = pose_[i] + world_.encoder_noise * normal_(random_);
  const Vector3d difference = (seen_pose_ - before) / kPeriod;
  seen_rate_ += kPeriod / (kPeriod + kRateFilter) * (difference - seen_rate_);
}

void PegPlant::step(const Vector3d& damping) {
  if (steps_ % kStepsPerSample == 0) {
    sample_encoders();
    Vector3d spring = stiffness_.cwiseProduct(reference_ - seen_pose_);
    spring.head<2>() = spring.head<2>().cwiseMax(-world_.largest_spring).cwiseMin(world_.largest_spring);
    drive_ = spring + damping.cwiseProduct(reference_rate_ - seen_rate_);
  }
  contact_force_.setZero();
  for (int i = 0; i < kContacts; ++i) {
    const ExactGap gap = exact_gap(world_.geometry, i, pose_, hole_);
    const auto at = static_cast<std::size_t>(i);
    gap_[at] = gap.value;
    pressure_[at] = 0;
    if (gap.value >= 0) continue;
    const double f = std::max(0.0, -world_.contact_stiffness * gap.value - damping_ * gap.normal.dot(rate_));
    const double slip = gap.tangent.dot(rate_);
    pressure_[at] = f;
    contact_force_ += f * (gap.normal - world_.friction * slip / std::hypot(slip, world_.friction_speed) * gap.tangent);
  }
  rate_ += kStep * 1e3 * (drive_ + contact_force_).cwiseQuotient(world_.mass);
  pose_ += kStep * rate_;
  reference_ += kStep * reference_rate_;
  filtered_force_ += kStep / world_.force_filter * (contact_force_ - filtered_force_);
  ++steps_;
  judge();
}

void PegPlant::judge() {
  const double force = contact_force_.head<2>().norm();
  if (force > 0 && first_touch_ < 0) first_touch_ = steps_;
  largest_force_ = std::max(largest_force_, force);
  if (first_touch_ >= 0 && kStep * static_cast<double>(steps_ - first_touch_) <= kFirstTouch)
    first_touch_peak_ = std::max(first_touch_peak_, force);

  millisecond_sum_ += force / kStepsPerSample;
  if (steps_ % kStepsPerSample == 0) {
    double& oldest = window_[static_cast<std::size_t>(steps_ / kStepsPerSample) % kSustained];
    window_sum_ += millisecond_sum_ - oldest;
    oldest = millisecond_sum_;
    millisecond_sum_ = 0;
    sustained_force_ = std::max(sustained_force_, window_sum_ / kSustained);
    success_ = depth(world_.geometry, pose_, hole_) >= world_.success_depth;
    time_ = time();
  }
}

void PegPlant::measure(VectorRef values) {
  const double lever = world_.geometry.lever;
  values.segment<3>(kMeasuredPose) = to_si(seen_pose_, lever);
  values.segment<3>(kMeasuredVelocity) = to_si(seen_rate_, lever);
  for (int i = 0; i < 3; ++i) {
    values[kMeasuredForce + i] = (filtered_force_[i] + world_.force_noise * normal_(random_)) * (i == 2 ? 1e-3 * lever : 1);
  }
  values.segment<3>(kMeasuredReference) = to_si(reference_, lever);
  values.segment<3>(kMeasuredRate) = to_si(reference_rate_, lever);
}

int PegPlant::num_outputs() const {
  return static_cast<int>(kOutputNames.size()) + 2 * kContacts;
}

std::string PegPlant::output_name(int i) const {
  const auto at = static_cast<std::size_t>(i);
  if (at < kOutputNames.size()) return kOutputNames[at];
  const std::size_t contact = at - kOutputNames.size();
  return contact < kContacts ? std::string("gap_") + kContactNames[contact] : std::string("lambda_") + kContactNames[contact - kContacts];
}

void PegPlant::outputs(VectorRef values) const {
  const double lever = world_.geometry.lever;
  values.segment<3>(0) = to_si(pose_, lever);
  values.segment<3>(3) = to_si(rate_, lever);
  values.segment<3>(6) = to_si(hole_, lever);
  values.segment<3>(9) = to_si(reference_, lever);
  values.segment<3>(12) << contact_force_.head<2>(), 1e-3 * lever * contact_force_[2];
  values[15] = 1e-3 * depth(world_.geometry, pose_, hole_);
  for (int i = 0; i < kContacts; ++i) {
    values[16 + i] = 1e-3 * gap_[static_cast<std::size_t>(i)];
    values[16 + kContacts + i] = pressure_[static_cast<std::size_t>(i)];
  }
}

int PegPlant::num_verdicts() const {
  return static_cast<int>(kVerdictNames.size());
}
std::string PegPlant::verdict_name(int i) const {
  return kVerdictNames[static_cast<std::size_t>(i)];
}
void PegPlant::verdicts(VectorRef values) const {
  values.segment<3>(0) = to_si(hole_, world_.geometry.lever);
  values.segment<6>(3) << (success_ ? 1 : 0), time_, first_touch_peak_, sustained_force_, largest_force_,
      1e-3 * depth(world_.geometry, pose_, hole_);
}

}  // namespace tenon::peg
