#include "tenon/problems/touch_down/plant.hpp"

#include <algorithm>
#include <cmath>

#include "tenon/core/random.hpp"

namespace tenon::touch_down {

namespace {

constexpr double kMicroStep = 1e-5;  // s; the contact's period is some 15 ms at 1e5 N/m and 0.6 kg
constexpr double kHeld = 0.02;       // of the wanted force
// what is asked of a soft touch
constexpr double kTouchSpeed = 0.015, kPeak = 8, kRebound = 5e-5, kHeldBy = 1.3;

}  // namespace

PlanePlant::PlanePlant(const World& world) : world_(world), damping_(2 * world.damping_ratio * std::sqrt(world.stiffness * world.mass)) {
  reset(0);
}

void PlanePlant::reset(std::uint64_t seed) {
  plane_ = world_.plane + (seed == 0 ? 0.0 : Random(seed).uniform(-world_.uncertainty, world_.uncertainty));
  z_ = world_.start;
  v_ = w_ = 0;
  steps_ = 0;
  tick_peak_ = 0;
  touched_ = false;
  touch_speed_ = peak_ = rebound_ = 0;
  held_since_ = 0;
}

double PlanePlant::contact_force() const {
  const double depth = z_ - plane_;
  return depth > 0 ? std::max(0.0, world_.stiffness * depth + damping_ * v_) : 0.0;
}

void PlanePlant::micro_step(double w) {
  v_ += kMicroStep * (w - contact_force() / world_.mass);
  z_ += kMicroStep * v_;
  ++steps_;
  const double force = contact_force();
  if (force > 0 && !touched_) {
    touched_ = true;
    touch_speed_ = v_;
  }
  tick_peak_ = std::max(tick_peak_, force);
  peak_ = std::max(peak_, force);
  if (touched_) rebound_ = std::max(rebound_, plane_ - z_);
  if (std::abs(force - world_.wanted_force) > kHeld * world_.wanted_force) held_since_ = static_cast<double>(steps_) * kMicroStep;
}

void PlanePlant::advance(double t_end, ConstVectorRef commands) {
  w_ = commands[0];
  tick_peak_ = contact_force();
  for (const long last = std::lround(t_end / kMicroStep); steps_ < last;) micro_step(w_);
}

void PlanePlant::measure(VectorRef values) {
  values << z_, v_, contact_force(), tick_peak_, w_;
}

std::string PlanePlant::output_name(int i) const {
  static const char* const kNames[] = {"z", "v", "plane", "gap_plane", "lambda_plane"};
  return kNames[i];
}

void PlanePlant::outputs(VectorRef values) const {
  values << z_, v_, plane_, plane_ - z_, contact_force();
}

std::string PlanePlant::verdict_name(int i) const {
  static const char* const kNames[] = {"plane", "success", "touched", "touch_speed", "peak_force", "rebound", "held_force", "held_since"};
  return kNames[i];
}

void PlanePlant::verdicts(VectorRef values) const {
  const bool held = held_since_ < static_cast<double>(steps_) * kMicroStep;
  const bool success = touched_ && touch_speed_ < kTouchSpeed && peak_ < kPeak && rebound_ < kRebound && held && held_since_ <= kHeldBy;
  values << plane_, success ? 1 : 0, touched_ ? 1 : 0, touch_speed_, peak_, rebound_, contact_force(), held_since_;
}

std::string PlanePlant::measurement_name(int i) const {
  static const char* const kNames[] = {"z", "v", "force", "force_peak", "w"};
  return std::string("measured_") + kNames[i];
}

}  // namespace tenon::touch_down
