// The delta robot's controller: a law at a fixed period, with what a machine needs around it.
//
//     e = r - z;   int e grows only where |ki int e| stays within its limit and no motor is at its own               (anti-windup)
//     r = r_0 + axis shift,   shift' = k_f (s_L - s_R)                                                               (tactile loop)
//     y' from the filtered difference of the angles, where the machine does not measure it                           (delta.md, section 8)
//
// All that it remembers is one value, which a simulation may copy, keep and put back: the same object runs there and on a robot. tick()
// neither allocates nor throws.
#pragma once

#include "tenon/problems/delta/law.hpp"
#include "tenon/problems/delta/low_pass.hpp"

namespace tenon::delta {

struct ControllerOptions {
  LawOptions law;
  double period = 1e-3;           // s
  double integral_limit = 1;      // of |ki int e|, m/s^2, each axis
  double filter_frequency = 0;    // Hz, of the angles' difference; 0: the rates are measured
  double tactile_gain = 0;        // k_f, m/(N s); 0: no tactile loop
  Vector3 tactile_axis{1, 0, 0};  // the direction in which sensor L pushes the reference, unit
  double tactile_limit = 0.05;    // of |shift|, m
};

/// Throws std::invalid_argument, naming the option, where one makes no sense.
void validate(const ControllerOptions& options);

struct Measurement {
  Vector3 angle{0, 0, 0};                      // y, rad
  Vector3 rate{0, 0, 0};                       // y', rad/s; not read where filter_frequency > 0
  double tactile_left = 0, tactile_right = 0;  // s_L, s_R, N
  Vector3 gimbal_angle{0, 0, 0};               // rad; not read where the robot has no gimbals
  Vector3 gimbal_rate{0, 0, 0};                // rad/s; as rate
};

struct Command {
  Vector3 torque{0, 0, 0};         // N m, within the limit
  Vector3 gimbal_torque{0, 0, 0};  // N m, within the limit
  bool saturated = false;          // a motor of the arms is at its limit
  bool singular = false;           // too near a singularity: the torque is that which last held the weight
  Vector3 wrist{0, 0, 0};          // z as measured
  Vector3 error{0, 0, 0};          // r - z
};

/// What is remembered of three angles to tell their rates.
struct DifferenceState {
  Vector3 previous{0, 0, 0};  // rad
  LowPass::State filter;
  bool has_previous = false;
};

/// What a controller remembers from tick to tick.
struct ControllerState {
  Vector3 integral{0, 0, 0};  // int(r - z), m s
  Vector3 holding{0, 0, 0};   // the torque that last held the weight, N m
  DifferenceState arms, gimbals;
  double shift = 0;  // of the reference by the tactile loop, m

  static constexpr int kSize = 27;
  void write(Eigen::Ref<Vector> numbers) const;
  static ControllerState read(const Eigen::Ref<const Vector>& numbers);
};

class Controller {
 public:
  /// Throws std::invalid_argument as validate() does.
  Controller(const Robot& robot, const ControllerOptions& options);

  /// As before the first tick, or as it was once.
  void reset(const ControllerState& state = {}) { state_ = state; }
  const ControllerState& state() const { return state_; }
  /// Holds until the next call.
  void set_reference(const Reference& reference) { reference_ = reference; }
  /// Of the gimbals, rad; holds until the next call.
  void set_tool_reference(const Vector3& angle) { tool_reference_ = angle; }
  /// The law's gains, where they are scheduled; holds until the next call.
  void set_law(const LawOptions& options) { law_.set_options(options); }

  const Command& tick(const Measurement& measurement);

  /// The reference as the tactile loop has moved it.
  Reference reference() const;
  const Law& law() const { return law_; }

 private:
  Vector3 rate(const Vector3& angle, const Vector3& measured, DifferenceState& state) const;
  void limit(const Vector3& torque);
  void turn_tool(const Measurement& measurement);
  /// The tactile loop's integrator; returns the rate at which the reference moves along the axis, m/s.
  double move_reference(const Measurement& measurement);
  void integrate();

  Law law_;
  ControllerOptions options_;
  LowPass filter_;
  Reference reference_;
  Vector3 tool_reference_{0, 0, 0};
  ControllerState state_;
  Command command_;
};

}  // namespace tenon::delta
