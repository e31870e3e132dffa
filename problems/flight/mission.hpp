// A mission, as data: which vehicle flies what, with which controller, sensors, actuators and misfortunes. FlightDae gives it equations.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "tenon/problems/allocation/vehicle.hpp"
#include "tenon/problems/flight/pose_controller.hpp"
#include "tenon/problems/flight/reference_path.hpp"

namespace tenon::flight {

struct Sensors {
  double position_noise = 0;  // m, standard deviation of each axis
  double attitude_noise = 0;  // rad, of each axis of the rotation vector
  double drop_out = 0;        // probability that a measurement is lost
  int delay = 0;              // ticks between a measurement and its command, beyond the hold
};

struct Actuators {
  double rotor_lag = 0.04;  // s, first order
  double servo_lag = 0.02;  // s, within the vehicle's angle-rate limit
};

/// A force on the vehicle, world axes: a steady part, and gusts with the spectrum of a first-order lag behind white noise.
struct Wind {
  Vector3d steady{0, 0, 0};  // N
  double deviation = 0;      // N, standard deviation of each axis
  double correlation = 1;    // s
};

struct Failure {
  enum class Kind { rotor, servo };  // no thrust any more; the arm stands still
  Kind kind = Kind::rotor;
  int rotor = 0;                     // from 0
  double t = 0;                      // s
  double detection = 0.1;            // s until the allocator knows; infinity: never
};

struct Mission {
  std::string name;
  Vehicle vehicle;  // normalised
  ReferencePath reference;
  PoseControllerOptions controller;
  Sensors sensors;
  Actuators actuators;
  Wind wind;
  double payload = 0;                // kg at the centre of mass
  std::vector<Failure> failures;
  double duration = 1;               // s
  double rtol = 1e-6;
  int output_ticks = 4;              // a row of the record every so many ticks
  double lost = 2;                   // m: so far from its reference a flight has failed
  std::uint64_t seed = 1;            // of noise, gusts and drop-outs

  double mass() const { return vehicle.mass + payload; }
};

}  // namespace tenon::flight
