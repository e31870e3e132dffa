// The wrenches that a set of rotors can give, asked for its boundary along a ray and for the least effort at a point: small convex programs.
//
//     farthest:      max t             s.t.  sum_i K_i y_i + e_i(y_i) = W + t d,   g_ij(y_i) >= 0                                (2.1)
//     least effort:  min sum_i u_i^2   s.t.  sum_i K_i y_i + e_i(y_i) = W,         g_ij(y_i) >= 0                                (2.2)
//
// Both by a primal-dual interior-point method (predictor and corrector) whose Newton system condenses to 6x6: envelope.md, section 3. The
// normal of (2.1) proves its answer: t <= support(normal) - normal'W for every normal with normal'd = 1.
#pragma once

#include <array>

#include "tenon/problems/envelope/rotor_reach.hpp"

namespace tenon {

/// Nothing allocates memory after construction.
class AttainableSet {
 public:
  struct Answer {
    bool solved = false;
    double length = 0;              // t; of (2.2): 0
    Wrench normal = Wrench::Zero();  // multipliers of the six rows
    std::array<Eigen::Vector2d, kMaxRotors> y;    // of each rotor
    int iterations = 0;
  };

  /// At most kMaxRotors rotors, as normalise() leaves them.
  explicit AttainableSet(const std::vector<Rotor>& rotors);

  /// (2.1) from a wrench that the set holds; without a component in a lost direction, else the length is 0.
  Answer farthest(const Wrench& from, const Wrench& direction) const;
  /// (2.2); not solved where the wrench is beyond the boundary.
  Answer least_effort(const Wrench& wrench) const;

  /// max normal'w over the set, by the true maps.
  double support(const Wrench& normal) const;
  /// The largest of the rotors' deviations from a convex set.
  double deviation() const;

  const std::vector<RotorReach>& rotors() const { return rotors_; }

 private:
  bool is_lost(const Wrench& wrench) const;
  Answer solve(const Wrench& from, const Wrench* direction) const;

  std::vector<RotorReach> rotors_;
  Eigen::Matrix<double, 6, Dynamic> lost_;  // orthonormal: lost_' K_i = 0 for all i
};

}  // namespace tenon
