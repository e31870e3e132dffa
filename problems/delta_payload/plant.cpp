#include "tenon/problems/delta_payload/plant.hpp"

#include <algorithm>
#include <cmath>

namespace tenon::delta_payload {

namespace {

using delta::Vector3;

constexpr double kMicroStep = 1e-3;  // s: nothing here is stiff

delta::Plant plant_of(const Parameters& parameters, double payload, double damping) {
  return {robot_with(parameters, payload, damping), {.period = parameters.period, .micro_step = kMicroStep}};
}

}  // namespace

PayloadPlant::PayloadPlant(const Parameters& parameters, const Prior& prior, const Eigen::Vector2d& stated)
    : parameters_(parameters), prior_(prior), stated_(stated), robot_(plant_of(parameters, stated[0], stated[1])) {
  reset(0);
}

void PayloadPlant::reset(std::uint64_t seed) {
  random_ = Random(seed);
  is_noisy_ = seed != 0;
  drawn_ = prior_.mean;
  drawn_.tail<2>() = stated_;
  if (is_noisy_) {
    for (int i = 0; i < kStates; ++i) {
      const double change = prior_.deviation[i] * random_.normal(), mean = prior_.mean[i];
      drawn_[i] = i < kPayload ? mean + change : mean * std::exp(change / mean);
    }
  }
  robot_ = plant_of(parameters_, drawn_[kPayload], drawn_[kDamping]);
  const delta::Forward forward = delta::forward_kinematics(parameters_.robot, drawn_.segment<3>(kAngle));
  const Vector3 velocity = delta::Motion(parameters_.robot, forward.at).jacobian * drawn_.segment<3>(kRate);
  lost_ = !forward.ok() || !robot_.place(forward.wrist, Vector3::Zero(), velocity);
  largest_torque_ = 0;
}

void PayloadPlant::advance(double, ConstVectorRef commands) {
  Vector3 torque = commands;
  if (is_noisy_) {
    for (double& value : torque) value += parameters_.torque_ripple * random_.normal();
  }
  lost_ = lost_ || !robot_.step(torque, Vector3::Zero(), [](const delta::ToolMotion&) { return delta::Wrench{}; });
  largest_torque_ = std::max(largest_torque_, robot_.torque().lpNorm<Eigen::Infinity>());
}

void PayloadPlant::measure(VectorRef values) {
  values = robot_.motors();
  if (!is_noisy_) return;
  for (double& value : values) value += parameters_.noise * random_.normal();
}

std::string PayloadPlant::output_name(int i) const {
  static const char* const kWrist[] = {"zx", "zy", "zz", "vx", "vy", "vz"};
  return i < kStates ? kStateNames[static_cast<std::size_t>(i)] : kWrist[i - kStates];
}

void PayloadPlant::outputs(VectorRef values) const {
  values << robot_.motors(), robot_.motor_rates(), drawn_[kPayload], drawn_[kDamping], robot_.wrist(), robot_.velocity();
}

std::string PayloadPlant::verdict_name(int i) const {
  static const char* const kNames[] = {"payload", "damping", "success", "largest_torque"};
  return kNames[i];
}

void PayloadPlant::verdicts(VectorRef values) const {
  values << drawn_[kPayload], drawn_[kDamping], lost_ ? 0 : 1, largest_torque_;
}

}  // namespace tenon::delta_payload
