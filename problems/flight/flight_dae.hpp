// A mission as a hybrid DAE: a rigid body under its rotors, and a controller whose clock strikes 240 times a second.       [flight.md]
//
//     p' = v                        m v' = q W_F - m g e_z + wind
//     q' = q (0, w)/2               J w' = W_M - w x J w
//     u' = (u_c - u)/T_r            a' = clip((a_c - a)/T_s, -limit, limit)            u_c = 0 of a rotor that has failed, a' = 0 of a stuck servo
//     0 = W - sum_i w_i(u_i, a_i)                                                                                     [flight.md, (1.1) to (1.5)]
//
// x = (p, q, v, w, u, a), y = W in body axes. What sensors, controller, allocator and wind hold between two ticks is in the mode; the
// allocator itself, which is the caller's, lives in the workspace and follows the ticks.
#pragma once

#include <functional>
#include <memory>

#include "tenon/core/dae.hpp"
#include "tenon/problems/flight/mission.hpp"
#include "tenon/problems/flight/rotors.hpp"

namespace tenon::flight {

/// An allocator of this vehicle, fresh.
using MakeAllocator = std::function<std::unique_ptr<Allocator>(const Vehicle&)>;

/// What the last tick did.
struct FlightTick {
  PoseReference reference;    // of its time
  double position_error = 0;  // m, of the true pose
  double angle_error = 0;     // rad
  Wrench asked = Wrench::Zero();   // body axes
  Wrench error = Wrench::Zero();   // what the allocation gives less what was asked
  AllocationStatus status = AllocationStatus::solved;
  Vector throttle, angle;          // N: as allocated
  int limits_violated = 0;         // so far: commands beyond a limit of throttle, angle or rate
};

/// What events are about: "throttle 3", "arm rate 3", "rotor 3", "servo 3".
inline constexpr const char *kThrottle = "throttle", *kArmRate = "arm rate", *kRotor = "rotor", *kServo = "servo";

class FlightDae final : public Dae {
 public:
  FlightDae(Mission mission, MakeAllocator make_allocator);

  int num_states() const override { return kRotors + 2 * rotors_.size(); }
  int num_algebraics() const override { return 6; }
  void initial_state(DaeState& state) const override;
  Workspace make_workspace() const override;

  void residual(const DaeMode& mode, const DaePoint& at, Workspace& workspace, VectorRef F) const override;
  void jacobian(const DaeMode& mode, const DaePoint& at, double alpha, Workspace& workspace, std::span<double> values) const override;
  bool has_derivatives() const override { return true; }
  void derivatives(const DaeMode& mode, double t, ConstVectorRef x, ConstVectorRef u, Workspace& workspace, VectorRef xdot,
                   VectorRef y) const override;

  double next_event_time(const DaeState& state) const override;
  /// A tick. The events are failures, and limits that begin or cease to bind: from and to are 0 (free), 1 (failed, or at the upper limit),
  /// -1 (at the lower). Ends the run where the vehicle is lost.
  Transition transition(DaeState& state, std::span<const int> fired, Workspace& workspace, const EventLog& log) const override;

  int num_outputs() const override;
  void outputs(const DaeState& state, Workspace& workspace, VectorRef values) const override;

  std::string name() const override { return mission_.name; }
  std::string state_name(int i) const override;
  std::string algebraic_name(int i) const override;
  std::string output_name(int i) const override;

  const Mission& mission() const { return mission_; }
  /// Of a state at which a tick was.
  void last_tick(const DaeState& state, FlightTick& tick) const;

 private:
  static constexpr int kAttitude = 3, kVelocity = 7, kRate = 10, kRotors = 13;  // in x

  /// Where things stand in the mode.
  struct Layout {
    int n, delay;
    // discrete: the ticks so far, the last allocation's status, how often a limit was violated; then n each
    static constexpr int kTicks = 0, kStatus = 1, kViolations = 2, kFlags = 3;
    int failed(int i) const { return kFlags + i; }
    int stuck(int i) const { return kFlags + n + i; }
    int throttle_limit(int i) const { return kFlags + 2 * n + i; }
    int rate_limit(int i) const { return kFlags + 3 * n + i; }
    int discrete_size() const { return kFlags + 4 * n; }
    // held: the commands (u, a) that the actuators have, those on their way, allocated last at the end; gust; what the allocation gives
    // beyond the wrench asked; the controller
    int commands_size() const { return 2 * n * (1 + delay); }
    int allocated() const { return 2 * n * delay; }
    int gust() const { return commands_size(); }
    int error() const { return gust() + 3; }
    int controller() const { return error() + 6; }
    int held_size() const { return controller() + PoseControllerState::kSize; }
  };
  struct Memory;

  Vector3d wind(const DaeMode& mode) const;
  /// u' and a'.
  void actuator_rates(const DaeMode& mode, ConstVectorRef x, VectorRef rates) const;
  void fail(DaeState& state, const EventLog& log) const;
  void blow(DaeState& state) const;
  bool measure(const DaeState& state, PoseMeasurement& measurement) const;
  void tick(DaeState& state, Memory& memory) const;
  void watch_limits(DaeState& state, ConstVectorRef last_angles, const EventLog& log) const;
  std::string lost(const DaeState& state) const;
  Wrench hover_wrench(double t) const;
  Wrench hover_error(double t, const Wrench& wrench) const;

  Mission mission_;
  MakeAllocator make_allocator_;
  Rotors rotors_;
  Layout at_;
};

}  // namespace tenon::flight
