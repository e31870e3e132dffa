#include "tenon/problems/peg_in_hole/baselines.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tenon/problems/peg_in_hole/channels.hpp"

namespace tenon::peg {

namespace {

constexpr double kDown = 20;                     // mm/s
constexpr double kAhead = 0.3 * kDown;           // mm: below the peg its reference goes no farther, as in the horizon's 0.3 s
constexpr double kTilt = std::numbers::pi / 18;  // rad
constexpr double kHook = 2.25;                   // mm: how far the tilted peg stands aside, so that its low corner is over the hole
constexpr double kTurn = 0.6;                    // rad/s
constexpr double kAside = 15, kLower = 15, kInsert = 30;  // mm/s
constexpr double kTouch = 1;                     // N
constexpr double kLargestRate = 40;              // mm/s, of a reference that gives way, as of the horizon's
// mm/s for each N. Times the damping of the inner loop it must stay well below 1 for a controller of 50 Hz: a rate is felt as a force at once.
constexpr double kAdmittance = 20, kInsertAdmittance = 8;

/// Towards a goal, no faster than this, and not beyond it within the period.
double towards(double from, double to, double speed, double period) {
  return std::clamp((to - from) / period, -speed, speed);
}

/// mm/s of x and phi for each N: phi in the ratio of the springs, so that both give way as fast.
Vector3d give_way(const Impedance& impedance, double admittance, const Vector3d& force) {
  const Vector3d& k = impedance.stiffness;
  return admittance * Vector3d(force[0], 0, k[0] / k[2] * force[2]);
}

}  // namespace

ReferenceController::ReferenceController(const Geometry& geometry, const Impedance& impedance, const Vector3d& start, double depth, double period)
    : geometry_(geometry), impedance_(impedance), depth_(depth), start_(start), reference_(start), period_(period) {}

int ReferenceController::num_measurements() const {
  return kMeasurements;
}
int ReferenceController::num_commands() const {
  return kCommands;
}
void ReferenceController::reset() {
  reference_ = start_;
}

void ReferenceController::update(double, ConstVectorRef measurements, VectorRef commands) {
  const double lever = geometry_.lever;
  const Vector3d pose = to_millimetres(measurements.segment<3>(kMeasuredPose), lever);
  const Vector3d force(measurements[kMeasuredForce], measurements[kMeasuredForce + 1], 1e3 / lever * measurements[kMeasuredForce + 2]);
  const Vector3d along = rate(reference_, pose, force);
  commands.segment<3>(kReference) = to_si(reference_, lever);
  commands.segment<3>(kReferenceRate) = to_si(along, lever);
  commands.segment<3>(kStiffness) = stiffness_to_si(impedance_.stiffness, lever);
  reference_ += period_ * along;
}

Vector3d StraightDown::rate(const Vector3d& reference, const Vector3d& pose, const Vector3d&) {
  return {0, towards(reference[1], std::max(-depth_, pose[1] - kAhead), kDown, period()), 0};
}

Vector3d Admittance::rate(const Vector3d& reference, const Vector3d& pose, const Vector3d& force) {
  const Vector3d give = give_way(impedance_, kAdmittance, force).cwiseMax(-kLargestRate).cwiseMin(kLargestRate);
  return StraightDown::rate(reference, pose, force) + give;
}

void TiltAndSlide::reset() {
  ReferenceController::reset();
  phase_ = Phase::lower;
}

Vector3d TiltAndSlide::rate(const Vector3d& reference, const Vector3d&, const Vector3d& force) {
  const double lever = geometry_.lever, theta = reference[2] / lever;
  if (phase_ == Phase::lower && theta > 0.99 * kTilt && force[1] > kTouch) phase_ = Phase::slide;
  if (phase_ == Phase::slide && force[0] > kTouch) phase_ = Phase::upright;
  if (phase_ == Phase::upright && theta <= 0) phase_ = Phase::insert;
  const Vector3d give = give_way(impedance_, kInsertAdmittance, force);
  switch (phase_) {
    case Phase::lower: {
      const double turn = towards(theta, kTilt, kTurn * 1.5, period());
      return {towards(reference[0], kHook, kAside, period()), theta > 0.99 * kTilt ? -kLower : -kDown / 4, lever * turn};
    }
    case Phase::slide: return {-kAside, 0, 0};
    case Phase::upright: {
      // about the left corner: q = corner + R(theta) (w/2, 0)
      const double turn = towards(theta, 0, kTurn, period()), half = geometry_.width / 2;
      return {-half * std::sin(theta) * turn + give[0], half * std::cos(theta) * turn, lever * turn};
    }
    case Phase::insert: return Vector3d(0, towards(reference[1], -depth_, kInsert, period()), 0) + give;
  }
  return Vector3d::Zero();
}

}  // namespace tenon::peg
