// The delta robot's controller: a law at a fixed period, with what a machine needs around it. All state is in the object.
//
//     e = r - z;   int e grows only where |ki int e| stays within its limit and no motor is at its own               (anti-windup)
//     r = r_0 + axis shift,   shift' = k_f (s_L - s_R)                                                               (tactile loop)
//     y' from the filtered difference of the angles, where the machine does not measure it                           (delta.md, section 8)
//
// The same object runs in the simulator and on a robot. tick() neither allocates nor throws.
#pragma once

#include "tenon/problems/delta/law.hpp"
#include "tenon/problems/delta/low_pass.hpp"

namespace tenon::delta {

struct ControllerOptions {
  LawOptions law;
  double period = 1e-3;             // s
  double integral_limit = 1;        // of |ki int e|, m/s^2, each axis
  double filter_frequency = 0;      // Hz, of the angles' difference; 0: the rates are measured
  double tactile_gain = 0;          // k_f, m/(N s); 0: no tactile loop
  Vector3 tactile_axis{1, 0, 0};    // the direction in which sensor L pushes the reference, unit
  double tactile_limit = 0.05;      // of |shift|, m
};

/// Throws std::invalid_argument, naming the option, where one makes no sense.
void validate(const ControllerOptions& options);

struct Measurement {
  Vector3 angle{0, 0, 0};                      // y, rad
  Vector3 rate{0, 0, 0};                       // y', rad/s; not read where filter_frequency > 0
  double tactile_left = 0, tactile_right = 0;  // s_L, s_R, N
};

struct Command {
  Vector3 torque{0, 0, 0};       // N m, within the limit
  bool saturated = false;        // a motor is at its limit
  bool singular = false;         // too near a singularity: the torque is that which last held the weight
  Vector3 wrist{0, 0, 0};        // z as measured
  Vector3 error{0, 0, 0};        // r - z
};

class Controller {
 public:
  /// Throws std::invalid_argument as validate() does.
  Controller(const Robot& robot, const ControllerOptions& options);

  /// As before the first tick.
  void reset();
  /// Holds until the next call.
  void set_reference(const Reference& reference) { reference_ = reference; }

  const Command& tick(const Measurement& measurement);

  /// The reference as the tactile loop has moved it.
  Reference reference() const;
  const Vector3& integral() const { return integral_; }  // int(r - z), m s
  double tactile_shift() const { return shift_; }        // m
  const Law& law() const { return law_; }

 private:
  Vector3 rate(const Measurement& measurement);
  void limit(const Vector3& torque);
  void integrate(const Measurement& measurement);

  Law law_;
  ControllerOptions options_;
  LowPass filter_;
  Reference reference_;
  Vector3 integral_{0, 0, 0}, previous_angle_{0, 0, 0}, holding_{0, 0, 0};
  double shift_ = 0;
  bool has_previous_ = false;
  Command command_;
};

}  // namespace tenon::delta
