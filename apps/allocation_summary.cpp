#include "tenon/apps/allocation_summary.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

#include "tenon/apps/statistics.hpp"
#include "tenon/apps/table.hpp"

namespace tenon {

AllocationSummary::AllocationSummary(const Vehicle& vehicle, std::string solver)
    : vehicle_(vehicle.name),
      solver_(std::move(solver)),
      linear_(vehicle),
      last_angle_(Vector::Zero(vehicle.num_rotors())),
      throttle_lowest_(std::numeric_limits<double>::infinity()),
      throttle_highest_(-throttle_lowest_) {}

void AllocationSummary::add(const Wrench& asked, double dt, bool has_past, const Allocation& allocation) {
  ++rows_;
  ++count_[static_cast<int>(allocation.status)];
  iterations_ += allocation.iterations;
  force_error_ = std::max(force_error_, allocation.error.head<3>().lpNorm<Eigen::Infinity>());
  torque_error_ = std::max(torque_error_, allocation.error.tail<3>().lpNorm<Eigen::Infinity>());
  residual_ = std::max(residual_, allocation.residual);
  throttle_lowest_ = std::min(throttle_lowest_, allocation.throttle.minCoeff());
  throttle_highest_ = std::max(throttle_highest_, allocation.throttle.maxCoeff());
  if (has_past) angle_rate_ = std::max(angle_rate_, (allocation.angle - last_angle_).lpNorm<Eigen::Infinity>() / dt);
  last_angle_ = allocation.angle;
  effort_.push_back(allocation.throttle.squaredNorm());
  const double bound = linear_.has_linear_thrust() && linear_.rank() == 6 ? linear_.effort_lower_bound(asked) : 0;
  if (bound > 0 && allocation.status == AllocationStatus::solved)
    over_bound_.push_back(std::max(0.0, effort_.back() / bound - 1));  // less is rounding
  seconds_.push_back(allocation.elapsed);
}

std::string AllocationSummary::text() const {
  std::string text = fmt::format("{}: {} rows by {}\n", vehicle_, rows_, solver_);
  const auto line = [&text](const char* what, const std::string& value) { text += fmt::format("  {:<18}{}\n", what, value); };
  line("status", fmt::format("{} solved, {} best_effort, {} fallback", count_[0], count_[1], count_[2]));
  line("wrench error", fmt::format("at most {:.2e} N, {:.2e} N m", force_error_, torque_error_));
  line("throttle", fmt::format("{:.4f} to {:.4f}", throttle_lowest_, throttle_highest_));
  line("angle rate", fmt::format("at most {:.4f} rad/s", angle_rate_));
  line("effort sum u^2", fmt::format("mean {:.6f}", mean(effort_)));
  if (!over_bound_.empty()) {
    line("above its bound", fmt::format("mean {:.3f} %, p99 {:.3f} %, at most {:.3f} %", 100 * mean(over_bound_),
                                        100 * percentile(over_bound_, 0.99), 100 * percentile(over_bound_, 1)));
  }
  line("residual", fmt::format("at most {:.2e}", residual_));
  line("iterations", fmt::format("{:.2f} per row", static_cast<double>(iterations_) / static_cast<double>(std::max(1L, rows_))));
  line("time per row", fmt::format("median {}, p99 {}", duration_text(median(seconds_)), duration_text(percentile(seconds_, 0.99))));
  if (linear_.rank() < 6) line("cannot give", fmt::format("{}", fmt::join(linear_.unreachable_directions(), ", ")));
  return text;
}

Json AllocationSummary::json() const {
  Json json = Json::object();
  json.set("schema", 1).set("vehicle", vehicle_).set("solver", solver_).set("rows", rows_);
  json.set("status", Json::object().set("solved", count_[0]).set("best_effort", count_[1]).set("fallback", count_[2]));
  json.set("wrench_error", Json::object().set("force", force_error_).set("torque", torque_error_));
  json.set("throttle", Json::object().set("min", throttle_lowest_).set("max", throttle_highest_));
  json.set("angle_rate_max", angle_rate_).set("effort_mean", mean(effort_));
  if (!over_bound_.empty()) {
    json.set(
        "effort_over_bound",
        Json::object().set("mean", mean(over_bound_)).set("p99", percentile(over_bound_, 0.99)).set("max", percentile(over_bound_, 1)));
  }
  json.set("residual_max", residual_).set("iterations", iterations_);
  json.set("time_s", Json::object().set("median", median(seconds_)).set("p99", percentile(seconds_, 0.99)));
  json.set("unreachable", linear_.unreachable_directions());
  return json;
}

}  // namespace tenon
