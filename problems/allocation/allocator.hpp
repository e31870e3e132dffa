// A wrench in, throttles and arm angles out, one control tick after the other.
#pragma once

#include <string_view>

#include "tenon/core/eigen.hpp"

namespace tenon {

using Wrench = Eigen::Matrix<double, 6, 1>;  // body axes: force (N), torque (N m)

enum class AllocationStatus {
  solved,       // the wrench is met, at the best effort
  best_effort,  // the limits forbid the wrench: the weighted error is as small as it can be
  fallback,     // the solver failed: the linear solution, clipped to the limits
};

constexpr std::string_view to_string(AllocationStatus status) {
  switch (status) {
    case AllocationStatus::solved: return "solved";
    case AllocationStatus::best_effort: return "best_effort";
    case AllocationStatus::fallback: return "fallback";
  }
  return "unknown";
}

struct Allocation {
  Vector throttle;          // N
  Vector angle;             // N, rad, multi-turn
  AllocationStatus status = AllocationStatus::fallback;
  int iterations = 0;
  double objective = 0;
  double residual = 0;      // infinity norm of the KKT residual
  Wrench error = Wrench::Zero();  // wrench of this command minus the wrench asked
  double elapsed = 0;       // s, the whole tick
};

/// Allocates tick by tick, each from the one before. After construction nothing allocates memory.
class Allocator {
 public:
  virtual ~Allocator() = default;

  /// Forgets the past: the next tick starts from the linear solution, without a rate limit or rate term.
  virtual void reset() = 0;
  /// Forgets the past but for these arm angles (N, rad), from which the next tick's rates count.
  virtual void reset(ConstVectorRef angles) = 0;

  /// The command for `wrench` (body axes), dt > 0 seconds after the one before. The reference stays valid until the next call.
  virtual const Allocation& allocate(const Wrench& wrench, double dt) = 0;

  /// From now on rotor i (from 0) gives no thrust; its throttle is 0.
  virtual void fail_rotor(int i) = 0;
  /// From now on the arm of rotor i stands still at its last angle.
  virtual void stick_servo(int i) = 0;
};

}  // namespace tenon
