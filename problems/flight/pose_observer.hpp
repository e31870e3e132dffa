// Position, velocity and disturbance of a rigid body from noisy poses, one tick after the other.
//
// Predicted by the wrench believed to act, corrected by the pose's innovation e with the gains of a fading memory of three states  [flight.md, (4)]
//
//     x += (1 - b^3) e,    v += 3/2 (1 - b)^2 (1 + b) e/T,    d += (1 - b)^3 e/T^2,      b = exp(-w T)
//
// so that all three poles lie at -w. d is the acceleration that the believed wrench does not explain: times mass or inertia it is the
// disturbance. Nothing here allocates or throws.
#pragma once

#include "tenon/problems/allocation/allocator.hpp"
#include "tenon/problems/flight/pose.hpp"

namespace tenon::flight {

struct RigidBody {
  double mass = 1;               // kg
  Vector3d inertia{1, 1, 1};     // kg m^2, diagonal, body axes
  double gravity = 9.80665;      // m/s^2

  /// Body axes, of the angular velocity there.
  Vector3d angular_acceleration(const Vector3d& torque, const Vector3d& rate) const {
    return (torque - rate.cross(inertia.cwiseProduct(rate))).cwiseQuotient(inertia);
  }
  /// World axes, of a force in body axes.
  Vector3d acceleration(const Vector3d& force, const Quaterniond& attitude) const {
    return attitude * force / mass - gravity * Vector3d::UnitZ();
  }
};

struct BodyEstimate {
  Vector3d position{0, 0, 0};              // m, world axes
  Vector3d velocity{0, 0, 0};              // m/s
  Vector3d unexplained{0, 0, 0};           // m/s^2, world axes
  Quaterniond attitude{1, 0, 0, 0};        // body to world
  Vector3d rate{0, 0, 0};                  // rad/s, body axes
  Vector3d unexplained_angular{0, 0, 0};   // rad/s^2, body axes
};

class PoseObserver {
 public:
  /// bandwidth w in rad/s, period T in s.
  PoseObserver(const RigidBody& body, double bandwidth, double period);

  /// A period on, under a wrench in body axes.
  void predict(const Wrench& wrench, BodyEstimate& estimate) const;
  void correct(const PoseMeasurement& measurement, BodyEstimate& estimate) const;

 private:
  RigidBody body_;
  double period_;
  double pose_gain_, rate_gain_, acceleration_gain_;
};

}  // namespace tenon::flight
