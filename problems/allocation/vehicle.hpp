// An over-actuated vehicle: rotors on turning (or fixed) arms, with the weights and limits of its allocation.
//
// Frame: body axes, z up. SI units. Sources: MOMAV controller notes; parameters of arXiv 2506.08868.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "tenon/core/eigen.hpp"

namespace tenon {

inline constexpr int kMinRotors = 3;
inline constexpr int kMaxRotors = 12;

struct Rotor {
  Eigen::Vector3d position{0, 0, 0};  // r, m
  Eigen::Vector3d axis{1, 0, 0};      // x, unit: the arm turns about it
  Eigen::Vector3d zero{0, 0, 1};      // z, unit: direction of the thrust at arm angle 0
  int spin = 1;                       // +1: the drag torque acts on the body along +n, -1: along -n
  std::vector<double> thrust;         // N, polynomial in the throttle, ascending coefficients
  std::vector<double> torque;         // N m, the same
  double throttle_lower = 0;
  double throttle_upper = 1;
  double angle_lower = -std::numeric_limits<double>::infinity();  // rad, multi-turn
  double angle_upper = std::numeric_limits<double>::infinity();
  double angle_rate_limit = std::numeric_limits<double>::infinity();  // rad/s
  bool tilt = true;                   // false: the arm stands at angle 0
  double fails_at = std::numeric_limits<double>::infinity();         // s: from then on the throttle is stuck at 0
  double servo_sticks_at = std::numeric_limits<double>::infinity();  // s: from then on the angle is stuck where it was
};

/// Weights of the objective, named as in MODELS: all six terms of the notes, and what tenon adds.
struct AllocationWeights {
  double throttle = 1;             // W_u
  double throttle_penalty = 0;     // W_up, beyond the two soft limits
  double throttle_soft_lower = 0;  // u_pL
  double throttle_soft_upper = 1;  // u_pH
  double angle_rate = 0;           // W_a, per (rad/s)^2
  double angle_rate_penalty = 0;   // W_ap, beyond the soft limit, per (rad/s)^2
  double angle_rate_soft = std::numeric_limits<double>::infinity();  // omega_p, rad/s
  double branch = 2.88;            // W_b, per rad^2: pull toward the branch of the linear solution, where limits are hard
  double force_error = 1;          // per N^2: the price of a wrench that cannot be had
  double torque_error = 400;       // per (N m)^2: 1/(.05 N m)^2, so that torque comes first
};

struct Vehicle {
  std::string name;
  double mass = 0;                       // kg
  Eigen::Vector3d inertia{0, 0, 0};      // kg m^2, diagonal
  double gravity = 9.80665;              // m/s^2
  bool hard_limits = true;               // throttle, angle and angle-rate limits as bounds, beside the soft penalties
  std::vector<Rotor> rotors;
  AllocationWeights weights;

  int num_rotors() const { return static_cast<int>(rotors.size()); }
};

/// Throws std::invalid_argument, naming rotor, key and value, where a vehicle makes no sense: fewer than 3 or more than 12 rotors, mass <= 0,
/// a zero axis, a spin that is not +-1, an empty polynomial, crossed limits. Directions are normalised; returns one note for each that was
/// not of unit length (beyond 1e-5, the rounding of published tables).
std::vector<std::string> normalise(Vehicle& vehicle);

}  // namespace tenon
