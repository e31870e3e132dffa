#include "tenon/problems/peg_in_hole/plant.hpp"

#include "tenon/problems/peg_in_hole/channels.hpp"
#include "tenon/problems/peg_in_hole/impedance.hpp"

namespace tenon::peg {

PegPlant::PegPlant(const World& world) : InsertionPlant(world) {
  PegPlant::reset(0);
}

void PegPlant::reset(std::uint64_t seed) {
  InsertionPlant::reset(seed);
  seen_.reset(pose_);
  drive_.setZero();
  filtered_force_.setZero();
}

void PegPlant::sample() {
  Vector3d reading;
  for (int i = 0; i < 3; ++i) reading[i] = pose_[i] + world_.encoder_noise * noise();
  seen_.update(reading, kPeriod);
  const Vector3d damping = Impedance{world_.mass, stiffness_}.damping();
  Vector3d spring = stiffness_.cwiseProduct(reference_ - reading);
  spring.head<2>() = spring.head<2>().cwiseMax(-world_.largest_spring).cwiseMin(world_.largest_spring);
  drive_ = spring + damping.cwiseProduct(reference_rate_ - seen_.rate());
}

void PegPlant::step() {
  if (is_sample()) sample();
  contacts_ = contacts(pose_, rate_);
  rate_ += kStep * 1e3 * (drive_ + contacts_.force).cwiseQuotient(world_.mass);
  pose_ += kStep * rate_;
  filtered_force_ += kStep / world_.force_filter * (contacts_.force - filtered_force_);
}

void PegPlant::measure(VectorRef values) {
  measure_motion(seen_.reading(), seen_.rate(), values);
  const Vector3d unit(1, 1, 1e-3 * world_.geometry.lever);
  for (int i = 0; i < 3; ++i) values[kMeasuredForce + i] = (filtered_force_[i] + world_.force_noise * noise()) * unit[i];
}

}  // namespace tenon::peg
