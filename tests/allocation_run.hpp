// A sequence of wrenches through an allocator, and what every such run is judged by.
#pragma once

#include <algorithm>
#include <vector>

#include "tenon/apps/make_allocator.hpp"
#include "tenon/core/nlp.hpp"
#include "tenon/problems/allocation/linear_allocation.hpp"
#include "tenon/problems/allocation/vehicle_file.hpp"
#include "tenon/problems/allocation/wrench_sequences.hpp"

namespace tenon {

inline Vehicle vehicle_with(const std::string& name, bool hard_limits) {
  Vehicle vehicle = load_vehicle(name).vehicle;
  vehicle.hard_limits = hard_limits;
  return vehicle;
}

struct AllocationRun {
  std::vector<Wrench> asked;
  std::vector<Allocation> rows;
  double throttle_lowest = kInfinity<double>, throttle_highest = -kInfinity<double>;
  double fastest = 0;      // rad/s, from the second row on
  double worst_error = 0;  // N, N m, of the rows that are solved
  std::vector<std::size_t> best_effort, fallback;

  /// Effort over its lower bound, minus 1.
  std::vector<double> over_bound(const Vehicle& vehicle) const {
    const LinearAllocation linear(vehicle);
    std::vector<double> over;
    for (std::size_t k = 0; k < rows.size(); ++k) over.push_back(rows[k].throttle.squaredNorm() / linear.effort_lower_bound(asked[k]) - 1);
    return over;
  }
};

/// `cold`: every row on its own.
inline AllocationRun run_allocator(Allocator& allocator, std::vector<Wrench> wrenches, bool cold = false, double dt = kSequenceStep) {
  AllocationRun run;
  run.asked = std::move(wrenches);
  for (std::size_t k = 0; k < run.asked.size(); ++k) {
    if (cold) allocator.reset();
    const Allocation& row = allocator.allocate(run.asked[k], dt);
    run.throttle_lowest = std::min(run.throttle_lowest, row.throttle.minCoeff());
    run.throttle_highest = std::max(run.throttle_highest, row.throttle.maxCoeff());
    if (k > 0 && !cold) run.fastest = std::max(run.fastest, (row.angle - run.rows.back().angle).lpNorm<Eigen::Infinity>() / dt);
    if (row.status == AllocationStatus::solved) run.worst_error = std::max(run.worst_error, row.error.lpNorm<Eigen::Infinity>());
    if (row.status == AllocationStatus::best_effort) run.best_effort.push_back(k);
    if (row.status == AllocationStatus::fallback) run.fallback.push_back(k);
    run.rows.push_back(row);
  }
  return run;
}

inline AllocationRun run_newton(const Vehicle& vehicle, std::vector<Wrench> wrenches, bool cold = false) {
  return run_allocator(*make_allocator(vehicle, "newton-kkt", {}), std::move(wrenches), cold);
}

/// Sum of W_k e_k^2, as the vehicle weighs them.
inline double weighted_error(const Vehicle& vehicle, const Wrench& error) {
  return vehicle.weights.force_error * error.head<3>().squaredNorm() + vehicle.weights.torque_error * error.tail<3>().squaredNorm();
}

}  // namespace tenon
