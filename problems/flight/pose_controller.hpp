// The pose controller: a measured pose in, the wrench that the rotors are to give out, at a fixed period.
//
//     F = -P e - I int e - D e' + m (a_ref + g e_z) - k F_est                    e = p - p_ref                     world axes
//     M = -P r - I int r - D (w - w_ref) + J alpha_ref + w x J w - k M_est       r of q_E = q_ref^-1 q             world axes
//
// |I int e| stays within a limit on each axis, and does not grow while the allocation is short of the wrench (conditional integration).
// Where the actuators' lag is compensated, pose and rates are predicted `lead` seconds ahead, to when the command acts; the reference is
// then that of t + lead. Sources: MOMAV controller notes; flight.md, sections 3 and 4.
//
// All that it remembers is one value, which a simulation may copy, keep and put back. tick() neither allocates nor throws.
#pragma once

#include "tenon/problems/flight/pose_observer.hpp"

namespace tenon::flight {

struct Gains {
  double proportional, integral, derivative;
  double integral_limit;  // of |I int e|, each axis
};

struct PoseControllerOptions {
  RigidBody body;                          // as the controller takes it to be
  Gains force{100, 200, 18, 10};           // N/m, N/(m s), N s/m, N
  Gains torque{1.8, 3.6, 0.25, 0.8};       // N m/rad, N m/(rad s), N m s/rad, N m
  double period = 1.0 / 240;               // s
  double observer_bandwidth = 20;          // rad/s
  double disturbance_share = 0;            // k: how much of the estimated disturbance wrench is subtracted, 0 to 1
  double actuator_lag = 0.03;              // s: how far the wrench that acts lags behind the one asked, as the observer takes it to be
  double lead = 0;                         // s
};

/// Throws std::invalid_argument, naming the option, where one makes no sense.
void validate(const PoseControllerOptions& options);

/// What a controller remembers from tick to tick.
struct PoseControllerState {
  BodyEstimate estimate;
  Vector3d force_integral{0, 0, 0};   // N: I int e, world axes
  Vector3d torque_integral{0, 0, 0};  // N m
  Wrench acting = Wrench::Zero();     // what is believed to act, body axes
  Wrench asked = Wrench::Zero();      // the last command
  bool is_short = false;              // the allocation could not give it
  bool has_estimate = false;

  static constexpr int kSize = 39;
  void write(Eigen::Ref<Vector> numbers) const;
  static PoseControllerState read(const Eigen::Ref<const Vector>& numbers);
};

class PoseController {
 public:
  /// Throws std::invalid_argument as validate() does.
  explicit PoseController(const PoseControllerOptions& options);

  /// As before the first tick, or as it was once.
  void reset(const PoseControllerState& state = {}) { state_ = state; }
  const PoseControllerState& state() const { return state_; }

  /// The wrench in body axes; no measurement (null) where it was lost: the estimate then goes on by itself. The first tick must have one.
  const Wrench& tick(const PoseMeasurement* measurement, const PoseReference& reference);

  /// What the allocation gave in place of the last wrench.
  void given(const Wrench& wrench, bool is_short) {
    state_.asked = wrench;
    state_.is_short = is_short;
  }

  const PoseControllerOptions& options() const { return options_; }

 private:
  void estimate(const PoseMeasurement* measurement);
  void integrate(const Vector3d& error, const Gains& gains, Vector3d& integral) const;

  PoseControllerOptions options_;
  PoseObserver observer_;
  double acting_share_;  // of the way from the wrench that acts to the one asked, in a period
  PoseControllerState state_;
};

/// Whether a loop of these gains is stable with its lag: mass a'' = -P a - I int a - D a', the force behind by a first-order lag (s).
bool is_stable(const Gains& gains, double mass, double lag);

}  // namespace tenon::flight
