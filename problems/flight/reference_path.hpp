// Where a vehicle should be, as a function of time, with the rates and accelerations that belong to it.                [flight.md, section 2]
//
//     legs           from pose to pose, at rest at both ends: p_0 + s(t) dp, exp(s(t) turn) q_0,  s = 10 x^3 - 15 x^4 + 6 x^5, x = t/duration
//     tumble         R_x(c_1 phi) R_y(c_2 phi): at a constant rate through all directions of gravity, c_2/c_1 the golden ratio
//     figure-eight   centre + size (sin phi, sin 2 phi / 2, sin phi / 4), rocking about x and y
//
// phi' rises from 0 to its rate within a ramp.
#pragma once

#include <vector>

#include "tenon/problems/flight/pose.hpp"

namespace tenon::flight {

struct Leg {
  double duration = 0;        // s; 0: a step
  Vector3d position{0, 0, 0}; // m, at its end
  Vector3d turn{0, 0, 0};     // rad: rotation vector in world axes, any number of turns
};

struct ReferencePath {
  enum class Kind { legs, tumble, figure_eight };

  Kind kind = Kind::legs;
  Vector3d position{0, 0, 0};        // m, at the start; the centre
  Quaterniond attitude{1, 0, 0, 0};  // at the start
  std::vector<Leg> legs;
  double rate = 0;                   // rad/s: of the tumble, or phi'
  double ramp = 2;                   // s
  double size = 0;                   // m
  double tilt = 0;                   // rad

  PoseReference at(double t) const;
};

}  // namespace tenon::flight
