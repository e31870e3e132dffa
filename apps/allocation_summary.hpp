// What a run of allocations amounts to, for people and for JSON.
#pragma once

#include <string>
#include <vector>

#include "tenon/apps/json.hpp"
#include "tenon/problems/allocation/allocator.hpp"
#include "tenon/problems/allocation/linear_allocation.hpp"
#include "tenon/problems/allocation/vehicle.hpp"

namespace tenon {

class AllocationSummary {
 public:
  AllocationSummary(const Vehicle& vehicle, std::string solver);

  /// `has_past`: false where the row started afresh, so that its angles have no rate.
  void add(const Wrench& asked, double dt, bool has_past, const Allocation& allocation);

  /// From now on the effort's bound is that of the vehicle without rotor i (from 0), or with its arm where it stood last.
  void fail_rotor(int i) { linear_.fail_rotor(i); }
  void stick_servo(int i) { linear_.stick_servo(i, last_angle_[i]); }

  std::string text() const;
  Json json() const;

 private:
  std::string vehicle_, solver_;
  LinearAllocation linear_;
  Vector last_angle_;
  long rows_ = 0, count_[3] = {0, 0, 0}, iterations_ = 0;
  double force_error_ = 0, torque_error_ = 0, residual_ = 0, angle_rate_ = 0;
  double throttle_lowest_, throttle_highest_;
  std::vector<double> effort_, over_bound_, seconds_;
};

}  // namespace tenon
