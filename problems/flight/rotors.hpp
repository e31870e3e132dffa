// What the rotors give at throttles and arm angles, with its derivatives, by the true thrust and torque maps.
//
//     W = sum_i [ mu n ; mu (r x n) + s tau n ],    n(a) = p_0 + cos a p_1 + sin a p_2                             [allocation.md, section 1]
#pragma once

#include <vector>

#include "tenon/problems/allocation/allocator.hpp"
#include "tenon/problems/allocation/vehicle.hpp"

namespace tenon::flight {

class Rotors {
 public:
  /// Copies what it needs of a vehicle that normalise() has accepted.
  explicit Rotors(const Vehicle& vehicle);

  int size() const { return static_cast<int>(rotors_.size()); }
  /// N throttles, N angles; body axes.
  Wrench wrench(ConstVectorRef u, ConstVectorRef a) const;
  /// dW/du and dW/da, 6 x N each.
  void jacobian(ConstVectorRef u, ConstVectorRef a, Eigen::Ref<Eigen::MatrixXd> by_u, Eigen::Ref<Eigen::MatrixXd> by_a) const;

 private:
  struct Plane {
    Wrench force[3], torque[3];  // w(1, 0; p_k), w(0, 1; p_k)
    std::vector<double> thrust, drag;
  };
  std::vector<Plane> rotors_;
};

}  // namespace tenon::flight
