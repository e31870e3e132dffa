// Control laws of the delta robot: motor torques from where it is, where it should be, and the integral of the difference.
//
//     linearising   w = r'' + kd (r' - z') + kp (r - z) + ki int(r - z)                                          (delta.md, section 7)
//                   u = M_y J_c^-1 (w - J_c' y') + Gamma' (C + D + M gbar) + tau_u
//     impedance     u = tau_u + J_c' [ K (r - z) + D (r' - z') ]
//     gimbals       linearised with both poles of each at -p, or a spring and a damper at each                   (section 10)
//
// A law has no state, so that it serves a controller's tick and a continuous simulation alike. Nothing here allocates or throws.
#pragma once

#include "tenon/problems/delta/dynamics.hpp"
#include "tenon/problems/delta/wrist_gimbals.hpp"

namespace tenon::delta {

struct Reference {
  Vector3 position{0, 0, 0};      // r, m
  Vector3 velocity{0, 0, 0};      // m/s
  Vector3 acceleration{0, 0, 0};  // m/s^2
};

struct Gains {
  double proportional = 0;  // kp, 1/s^2
  double derivative = 0;    // kd, 1/s
  double integral = 0;      // ki, 1/s^3
};

/// All three poles of s^3 + kd s^2 + kp s + ki at -p (1/s).
constexpr Gains place_poles(double p) {
  return {3 * p * p, 3 * p, p * p * p};
}
inline constexpr Gains kDefaultGains = place_poles(7);
inline constexpr Gains kLowGains{1, 0.25, 0};  // of the published demonstration

enum class LawForm { linearising, impedance };

struct LawOptions {
  LawForm form = LawForm::linearising;
  Gains gains = kDefaultGains;
  ReducedInertia inertia = ReducedInertia::exact;
  bool feed_forward = true;                // r''
  bool coriolis = true;                    // C, M gbar and J_c' y'
  bool damping = true;                     // D
  Vector3 stiffness{200, 200, 200};        // K, N/m; impedance only
  Vector3 impedance_damping{20, 20, 20};   // D, N s/m; impedance only
  double tool_pole = 20;                   // p of the gimbals, 1/s; linearising only
  Vector3 tool_stiffness{0.2, 0.2, 0.2};   // N m/rad; impedance only
  Vector3 tool_damping{0.01, 0.01, 0.01};  // N m s/rad; impedance only
};

/// Where the robot is, as a law needs it.
struct Sensed {
  bool ok = false;          // false: at or beyond a singularity, no torque can be worked out
  Vector3 y_rate;           // of the motors, rad/s
  Vector3 wrist, velocity;  // z, z'
  Configuration at;
  Motion motion;

  /// From the motors' angles (rad) and rates (rad/s).
  Sensed(const Robot& robot, const Vector3& y, const Vector3& rate) : Sensed(robot, forward_kinematics(robot, y), rate) {}
  /// From all nine angles and rates, as a simulation has them.
  Sensed(const Robot& robot, const Configuration& configuration, const Vector9& v);

 private:
  Sensed(const Robot& robot, const Forward& forward, const Vector3& rate);
};

struct LawTorque {
  Vector3 torque;   // N m
  Vector3 gravity;  // tau_u, the part that holds the robot up
};

class Law {
 public:
  Law(const Robot& robot, const LawOptions& options)
      : robot_(robot), constants_(robot), gimbals_{robot.gimbal_inertia}, options_(options) {}

  /// Gains may change from tick to tick.
  void set_options(const LawOptions& options) { options_ = options; }

  /// `integral` is int(r - z), m s. Without torque limits. Asks for sensed.ok.
  LawTorque torque(const Sensed& sensed, const Reference& reference, const Vector3& integral) const;
  /// Of the gimbals, from their angles (rad), rates (rad/s) and where they should be. Without torque limits.
  Vector3 tool_torque(const Vector3& angle, const Vector3& rate, const Vector3& reference) const;

  const Robot& robot() const { return robot_; }
  bool has_gimbals() const { return gimbals_.are_there(); }
  const ArmConstants& constants() const { return constants_; }
  const LawOptions& options() const { return options_; }

 private:
  Vector3 linearising(const Sensed& sensed, const Reference& reference, const Vector3& integral) const;
  Vector3 impedance(const Sensed& sensed, const Reference& reference) const;

  Robot robot_;
  ArmConstants constants_;
  WristGimbals gimbals_;
  LawOptions options_;
};

}  // namespace tenon::delta
