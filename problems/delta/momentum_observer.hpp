// The wrench on the tool from what motors and gimbals read and push with: generalised momentum, and what of it nothing known accounts for.
//
//     rho = K [ M z' - int ( M' z' + known forces + rho ) ]    =>    rho' = K (f - rho)                        (delta.md, section 13)
//
// In the coordinates of the wrist and of the gimbals. rho follows the force f from outside like a low-pass of 1/K, with no acceleration
// measured and no mass matrix inverted. Asks for the robot's masses and friction: what those are wrong by shows as force. update() neither
// allocates nor throws.
#pragma once

#include "tenon/problems/delta/plant.hpp"

namespace tenon::delta {

struct MomentumObserverOptions {
  double period = 1e-3;   // s, from update to update
  double gain = 200;      // K, 1/s
  Vector3 tool{0, 0, 0};  // m: the tool's point from the gimbals' centre, in the tool's frame
};

class MomentumObserver {
 public:
  /// Throws std::invalid_argument where period or gain is not positive.
  MomentumObserver(const Robot& robot, const MomentumObserverOptions& options);

  /// As before the first update.
  void reset();

  /// The angles (rad) now, and the torques (N m) that were held since the update before. The wrench at the tool's point, world axes; the
  /// one before where the angles are those of no pose. Without gimbals its moment stays zero.
  const Wrench& update(const Vector3& motors, const Vector3& gimbals, const Vector3& torque, const Vector3& gimbal_torque);
  const Wrench& wrench() const { return wrench_; }

 private:
  /// A position, and the mean rate and the torque of the period that led to it.
  struct Reading {
    Vector3 position{0, 0, 0}, rate{0, 0, 0}, torque{0, 0, 0};
  };
  /// At the reading before: means over the two periods that meet there, and what the rate changes by.
  struct Step {
    Vector3 position, rate, torque, acceleration;
  };
  Step take(Reading& before, const Vector3& position, const Vector3& torque) const;

  Robot robot_;
  ArmConstants constants_;
  WristGimbals gimbals_;
  MomentumObserverOptions options_;
  double share_;  // of what is new, 1 - exp(-K T)
  int readings_ = 0;
  Configuration at_;  // of the wrist's reading
  Reading wrist_, turned_;
  Vector3 force_{0, 0, 0}, torque_{0, 0, 0};  // rho, of wrist and gimbals
  Wrench wrench_;
};

}  // namespace tenon::delta
