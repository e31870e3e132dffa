// What a vehicle's motion is at one instant: where it should be, and what is seen of where it is.
#pragma once

#include "tenon/problems/flight/rotation.hpp"

namespace tenon::flight {

/// World axes throughout; attitude is body to world.
struct PoseReference {
  Vector3d position{0, 0, 0};              // m
  Vector3d velocity{0, 0, 0};              // m/s
  Vector3d acceleration{0, 0, 0};          // m/s^2
  Quaterniond attitude{1, 0, 0, 0};        // unit
  Vector3d angular_velocity{0, 0, 0};      // rad/s
  Vector3d angular_acceleration{0, 0, 0};  // rad/s^2
};

struct PoseMeasurement {
  Vector3d position{0, 0, 0};          // m, world axes
  Quaterniond attitude{1, 0, 0, 0};    // unit, body to world
  bool has_rates = false;              // else they are estimated from the poses
  Vector3d velocity{0, 0, 0};          // m/s, world axes
  Vector3d angular_velocity{0, 0, 0};  // rad/s, body axes
};

}  // namespace tenon::flight
