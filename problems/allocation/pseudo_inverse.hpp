// The linear solution as an allocator of its own: what `tenon allocate --solver pseudo-inverse` runs, and the yardstick of the others.
//
// Throttles are clipped to their limits, angles and their rates too where the vehicle's limits are hard; what that costs shows in the
// wrench error. Where the torque is not a fixed share of the thrust, the target is moved by the error and solved again, a few times.
#pragma once

#include <memory>

#include "tenon/problems/allocation/allocator.hpp"
#include "tenon/problems/allocation/linear_allocation.hpp"
#include "tenon/problems/allocation/vehicle.hpp"

namespace tenon {

class PseudoInverse final : public Allocator {
 public:
  explicit PseudoInverse(const Vehicle& vehicle);

  void reset() override;
  void reset(ConstVectorRef angles) override;
  const Allocation& allocate(const Wrench& wrench, double dt) override;
  void fail_rotor(int i) override;
  void stick_servo(int i) override;

 private:
  bool clip(double dt);
  double objective(double dt) const;

  Vehicle vehicle_;
  LinearAllocation linear_;
  Vector previous_;           // N, rad
  bool has_history_ = false;  // false: no rate limit or rate term in the next tick
  Allocation allocation_;
};

}  // namespace tenon
