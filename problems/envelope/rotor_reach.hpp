// What one rotor can give: a convex set of thrust vectors, and the true maps it stands for.
//
// A tilting rotor is a vector in the plane across its arm, in units of its largest thrust M (envelope.md, section 1):
//
//     y = m/M (cos a, sin a),    w = K y + e(y),    K = M [ w(1, k; p_1)  w(1, k; p_2) ],    k = tau/mu at full throttle           (1.3)
//
// A rotor that does not tilt has one column, the second is 0. The set is  g_j(y) = b + a'y - c/2 |y|^2 >= 0  for each limit: one disc of
// throttle, two half-planes of angle; or the two ends of a fixed rotor's throttle. e(y) is what K leaves out: rounding of published axes, a
// torque that is not quite proportional to the thrust.
#pragma once

#include "tenon/problems/allocation/allocator.hpp"
#include "tenon/problems/allocation/vehicle.hpp"

namespace tenon {

class RotorReach {
 public:
  struct Limit {
    double b = 0;
    Eigen::Vector2d a{0, 0};
    double c = 0;
    double value(const Eigen::Vector2d& y) const { return b + a.dot(y) - 0.5 * c * y.squaredNorm(); }
    Eigen::Vector2d gradient(const Eigen::Vector2d& y) const { return a - c * y; }
  };
  /// u^2 as a function of y: its Hessian is `along` in the direction ahead, `across` at a right angle to it.
  struct Effort {
    Eigen::Vector2d gradient, ahead;
    double along, across;
  };
  struct Command {
    double throttle, angle;
  };

  explicit RotorReach(const Rotor& rotor);

  const Eigen::Matrix<double, 6, 2>& columns() const { return columns_; }  // K
  int num_limits() const { return num_limits_; }
  const Limit& limit(int j) const { return limits_[j]; }
  const Eigen::Vector2d& centre() const { return centre_; }  // well within all limits
  bool tilts() const { return rotor_.tilt; }

  /// How far the true set is from the convex one, of its size: |x.z|, or the torque's distance from k times the thrust. Infinite where the
  /// true set is not convex at all: a tilting rotor whose least thrust is not 0, an arm that covers more than half a turn but not a whole
  /// one, a thrust that falls.
  double deviation() const { return deviation_; }

  Effort effort(const Eigen::Vector2d& y) const;
  Wrench miss(const Eigen::Vector2d& y) const;  // e(y)
  Command command(const Eigen::Vector2d& y) const;
  double thrust(double throttle) const;

  /// max n'w over all commands within the limits, by the true maps. (1.5)
  double support(const Wrench& normal) const;

 private:
  double throttle_of(double thrust) const;
  double support_at(double throttle, const Wrench& normal) const;

  Rotor rotor_;
  std::vector<double> slope_;               // mu', as coefficients
  Eigen::Vector3d directions_[3];           // p_0, p_1, p_2
  Eigen::Matrix<double, 6, 2> columns_;
  Limit limits_[3];
  int num_limits_ = 0;
  Eigen::Vector2d centre_{0, 0};
  Wrench along_;                            // M w(1, k; p_0)
  double largest_ = 1, torque_ratio_ = 0;   // M, k
  double deviation_ = 0;
  bool is_linear_ = false, is_proportional_ = true, is_exact_ = true;
};

}  // namespace tenon
