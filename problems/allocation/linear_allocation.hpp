// The linear solution of wrench allocation: a pseudo-inverse, one arctangent per arm. Start, fall-back and yardstick of the nonlinear one.
//
// A tilting rotor is a vector in the plane across its arm, c + i s = v exp(i a) with v = thrust / kappa, where kappa = thrust(u*) / u* is
// the secant slope at the hover throttle u*. For a linear map that is the slope itself, and v the throttle.
//
//     [c; s] = K^+ W,    K = [ .. kappa_i w_i(z_i)  kappa_i w_i(y_i) .. ],    y = x x z                                          (1)
//     w_i(d) = [ d ; r_i x d + s_i k_i d ],    k = torque / thrust at u*
//     v = hypot(c, s),    u = thrust^-1(kappa v),    a = atan2(s, c) unwrapped to the turn of the previous angle                 (2)
//
// A fixed rotor or stuck servo has one column, a failed rotor none. K^+ weighs wrench errors as the vehicle does, so that a rank-deficient
// vehicle gives up what costs least. Where x and z are not quite orthogonal, z = z_perp + p x, the part along x goes to the right:
//
//     [c; s] <- K^+ (W - Q v),    Q = [ .. kappa_i p_i w_i(x_i) .. ]                                                            (3)
//
// For linear maps |c|^2 + |s|^2 = W' (K K')^-1 W is the least sum of squared throttles that any command needs for W (limits aside).
#pragma once

#include <string>
#include <vector>

#include "tenon/problems/allocation/allocator.hpp"
#include "tenon/problems/allocation/vehicle.hpp"

namespace tenon {

/// After construction nothing allocates memory, but for unreachable_directions().
class LinearAllocation {
 public:
  /// Copies what it needs of a vehicle that normalise() has accepted.
  explicit LinearAllocation(const Vehicle& vehicle);

  /// Throttles and angles (N each) for a wrench in body axes. Limits are not looked at: u may lie outside them, where the thrust map is
  /// continued straight. An arm without thrust keeps its previous angle. u and a must not overlap the inputs, a may be previous_angles.
  void solve(const Wrench& wrench, ConstVectorRef previous_angles, VectorRef u, VectorRef a) const;

  /// W' (K K')^+ W: for linear maps the least sum of squared throttles that any command needs for the reachable part of W.
  double effort_lower_bound(const Wrench& wrench) const { return wrench.dot(effort_ * wrench); }

  /// Multipliers of the wrench rows where sum v^2 is least: -2 (K K')^+ W.
  Wrench effort_multipliers(const Wrench& wrench) const { return -2 * (effort_ * wrench); }

  /// What a command (N throttles, N angles) gives, by the true maps.
  Wrench wrench(ConstVectorRef u, ConstVectorRef a) const;

  /// From now on without rotor i (from 0), or with its arm standing at `angle`.
  void fail_rotor(int i);
  void stick_servo(int i, double angle);

  /// 6 where every wrench can be had, limits aside.
  int rank() const { return rank_; }
  /// One text for each lost direction, such as "force along body x"; a mixed one as "0.8 Fx + 0.6 My".
  std::vector<std::string> unreachable_directions() const;

  /// Whether every thrust is proportional to its throttle, so that effort_lower_bound() is a bound.
  bool has_linear_thrust() const;

  int num_rotors() const { return num_rotors_; }

 private:
  enum class Kind { tilting, fixed, failed };

  struct Arm {
    Kind kind = Kind::tilting;
    Eigen::Vector3d position, axis;  // r, x
    Eigen::Vector3d zero, across;    // z without its part along x, and y = x x z
    double along = 0;                // p, the part of z along x
    double angle = 0;                // of a fixed arm
    int spin = 1;
    double kappa = 1;                    // N: thrust of v = 1
    double torque_ratio = 0;             // k, m
    bool linear_thrust = true;           // thrust = kappa u
    std::vector<double> thrust, torque;  // ascending coefficients
    double throttle_lower = 0, throttle_upper = 1;
  };

  using Pairs = Eigen::Matrix<double, 2 * kMaxRotors, 1>;

  void factor();
  double throttle_of(const Arm& arm, double thrust) const;

  int num_rotors_ = 0;
  int rank_ = 0;
  int corrections_ = 0;  // passes of (3), 0 where x and z are orthogonal
  Arm arms_[kMaxRotors];
  double force_scale_ = 1, torque_scale_ = 1;                // square roots of the error weights
  Eigen::Matrix<double, 2 * kMaxRotors, 6> inverse_;         // K^+, rows c_1, s_1, c_2, ...; rows of absent unknowns are 0
  Eigen::Matrix<double, 2 * kMaxRotors, kMaxRotors> drift_;  // K^+ Q
  Eigen::Matrix<double, 6, 6> effort_;                       // (K K')^+
  Eigen::Matrix<double, 6, 6> null_;                         // its first 6 - rank columns: directions with v' K = 0
};

}  // namespace tenon
