// What a flight amounts to, tick by tick: errors of the true pose, what the allocation could not do, limits.
#pragma once

#include <algorithm>
#include <cmath>

#include "tenon/problems/flight/flight_dae.hpp"

namespace tenon::flight {

/// Mean, standard deviation and largest of what was added.
class Moments {
 public:
  void add(double value) {
    ++count_;
    const double off = value - mean_;
    mean_ += off / static_cast<double>(count_);  // [Welford 1962]
    squares_ += off * (value - mean_);
    max_ = std::max(max_, value);
  }
  double mean() const { return mean_; }
  double sd() const { return count_ > 1 ? std::sqrt(squares_ / static_cast<double>(count_ - 1)) : 0; }
  double max() const { return max_; }

 private:
  long count_ = 0;
  double mean_ = 0, squares_ = 0, max_ = 0;
};

struct FlightStatistics {
  Moments position_error;  // m
  Moments angle_error;     // rad
  long ticks = 0;
  long best_effort = 0;           // ticks whose wrench the limits forbade
  long allocation_failures = 0;   // ticks without a solution: the fall-back flew
  long limits_hit = 0;            // times that a throttle or an arm's rate came to its limit
  long limits_violated = 0;       // commands beyond a limit
  double largest_force_error = 0, largest_torque_error = 0;  // N, N m, of the allocation

  void add(const FlightTick& tick) {
    ++ticks;
    position_error.add(tick.position_error);
    angle_error.add(tick.angle_error);
    best_effort += tick.status == AllocationStatus::best_effort;
    allocation_failures += tick.status == AllocationStatus::fallback;
    limits_violated = tick.limits_violated;
    largest_force_error = std::max(largest_force_error, tick.error.head<3>().norm());
    largest_torque_error = std::max(largest_torque_error, tick.error.tail<3>().norm());
  }
  void add(const DaeEvent& event) {
    limits_hit += event.to != 0 && (event.contact.starts_with(kThrottle) || event.contact.starts_with(kArmRate));
  }
};

}  // namespace tenon::flight
