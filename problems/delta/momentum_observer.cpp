#include "tenon/problems/delta/momentum_observer.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace tenon::delta {

MomentumObserver::MomentumObserver(const Robot& robot, const MomentumObserverOptions& options)
    : robot_(robot),
      constants_(robot),
      gimbals_{robot.gimbal_inertia},
      options_(options),
      share_(-std::expm1(-options.gain * options.period)) {
  const auto require = [](bool holds, const char* name, double value) {
    if (!holds) throw std::invalid_argument(std::string(name) + " is " + std::to_string(value) + " (expected more than 0)");
  };
  require(options.period > 0, "period", options.period);
  require(options.gain > 0, "gain", options.gain);
}

void MomentumObserver::reset() {
  readings_ = 0;
  force_.setZero(), torque_.setZero();
  wrench_ = {};
}

MomentumObserver::Step MomentumObserver::take(Reading& before, const Vector3& position, const Vector3& torque) const {
  const Vector3 rate = (position - before.position) / options_.period;
  const Step step{before.position, (before.rate + rate) / 2, (before.torque + torque) / 2, (rate - before.rate) / options_.period};
  before = {position, rate, torque};
  return step;
}

const Wrench& MomentumObserver::update(const Vector3& motors, const Vector3& gimbals, const Vector3& torque, const Vector3& gimbal_torque) {
  const Forward forward = forward_kinematics(robot_, motors);
  if (!forward.ok()) return wrench_;
  const Configuration at = at_;
  at_ = forward.at;
  const Step wrist = take(wrist_, forward.wrist, torque), turned = take(turned_, gimbals, gimbal_torque);
  // a rate takes two readings, its change three
  readings_ = std::min(readings_ + 1, 3);
  if (readings_ < 3) return wrench_;

  // (13.2)
  const WristBalance balance = wrist_balance(robot_, constants_, at, wrist.rate, wrist.torque, Vector3::Zero());
  force_ += share_ * (balance.inertia * wrist.acceleration - balance.force - force_);
  wrench_.force = force_;
  if (!gimbals_.are_there()) return wrench_;
  const Vector3 needed = gimbals_.linearising_torque(turned.position, turned.rate, turned.acceleration);
  torque_ += share_ * (needed - turned.torque - torque_);
  const GimbalFrame frame(turned.position);
  // E' (M + a x F) = torque, a from the gimbals' centre to the tool's point
  wrench_.moment = frame.axes.transpose().inverse() * torque_ - (frame.attitude * options_.tool).cross(force_);
  return wrench_;
}

}  // namespace tenon::delta
