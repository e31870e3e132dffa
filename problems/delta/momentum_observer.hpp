// The wrench on the tool from what motors and gimbals read and push with: generalised momentum, and what of it nothing known accounts for.
//
//     p = M(z) z',    r = K [ p - int ( M' z' + known forces + r ) ]    =>    r' = K (f - r)                   (delta.md, section 13)
//
// In the coordinates of the wrist and of the gimbals. r follows the force f from outside like a low-pass of 1/K, without an acceleration
// measured or a mass matrix inverted. Asks for the robot's masses and friction: what those are wrong by shows as force. update() neither
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
  /// Of two updates or, of rates and torques, of the two periods that meet at the first.
  struct Reading {
    Vector3 position{0, 0, 0}, rate{0, 0, 0}, torque{0, 0, 0};
  };
  struct Step {
    Vector3 position, rate, torque, acceleration;  // at the reading before; means of the two periods about it
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
  Vector3 force_{0, 0, 0}, torque_{0, 0, 0};  // r, of wrist and gimbals
  Wrench wrench_;
};

}  // namespace tenon::delta
