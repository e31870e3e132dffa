#include "tenon/problems/allocation/pseudo_inverse.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace tenon {

namespace {

constexpr double kWrenchTolerance = 1e-8;  // relative: an attainable wrench is met to this
constexpr int kMaxPasses = 20;

/// w (v - soft limit)^2 beyond the limits
double penalty(double value, double lower, double upper) {
  const double beyond = std::max({lower - value, value - upper, 0.0});
  return beyond * beyond;
}

}  // namespace

PseudoInverse::PseudoInverse(const Vehicle& vehicle) : vehicle_(vehicle), linear_(vehicle), previous_(Vector::Zero(vehicle.num_rotors())) {
  allocation_.throttle.setZero(vehicle.num_rotors());
  allocation_.angle.setZero(vehicle.num_rotors());
}

void PseudoInverse::reset() {
  previous_.setZero();
  has_history_ = false;
}

void PseudoInverse::reset(ConstVectorRef angles) {
  previous_ = angles;
  has_history_ = true;
}

const Allocation& PseudoInverse::allocate(const Wrench& wrench, double dt) {
  const auto start = std::chrono::steady_clock::now();
  const double tolerance = kWrenchTolerance * std::max(1.0, wrench.lpNorm<Eigen::Infinity>());
  Wrench target = wrench;
  double last_error = std::numeric_limits<double>::infinity();
  for (int pass = 1; pass <= kMaxPasses; ++pass) {
    linear_.solve(target, previous_, allocation_.throttle, allocation_.angle);
    const bool clipped = clip(dt);
    allocation_.error = linear_.wrench(allocation_.throttle, allocation_.angle) - wrench;
    allocation_.iterations = pass;
    allocation_.residual = allocation_.error.lpNorm<Eigen::Infinity>();
    if (clipped || allocation_.residual <= 1e-3 * tolerance || allocation_.residual >= last_error) break;
    last_error = allocation_.residual;
    target -= allocation_.error;
  }
  allocation_.status = allocation_.residual <= tolerance ? AllocationStatus::solved : AllocationStatus::best_effort;
  allocation_.objective = objective(dt);
  previous_ = allocation_.angle;
  has_history_ = true;
  allocation_.elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return allocation_;
}

bool PseudoInverse::clip(double dt) {
  bool clipped = false;
  const auto limit = [&clipped](double& value, double lower, double upper) {
    const double inside = std::min(std::max(value, lower), upper);
    clipped = clipped || inside != value;
    value = inside;
  };
  for (int i = 0; i < vehicle_.num_rotors(); ++i) {
    const Rotor& rotor = vehicle_.rotors[static_cast<std::size_t>(i)];
    limit(allocation_.throttle[i], rotor.throttle_lower, rotor.throttle_upper);
    if (!vehicle_.hard_limits || !rotor.tilt) continue;
    limit(allocation_.angle[i], rotor.angle_lower, rotor.angle_upper);
    if (!has_history_) continue;
    const double reach = rotor.angle_rate_limit * dt;
    limit(allocation_.angle[i], previous_[i] - reach, previous_[i] + reach);
  }
  return clipped;
}

double PseudoInverse::objective(double dt) const {
  // O = sum W_u u^2 + W_up (u beyond its soft limits)^2 + W_a omega^2 + W_ap (omega beyond its soft limit)^2
  const AllocationWeights& weights = vehicle_.weights;
  double sum = 0;
  for (int i = 0; i < vehicle_.num_rotors(); ++i) {
    const double u = allocation_.throttle[i];
    const double omega = has_history_ ? (allocation_.angle[i] - previous_[i]) / dt : 0;
    sum += weights.throttle * u * u + weights.throttle_penalty * penalty(u, weights.throttle_soft_lower, weights.throttle_soft_upper);
    sum +=
        weights.angle_rate * omega * omega + weights.angle_rate_penalty * penalty(omega, -weights.angle_rate_soft, weights.angle_rate_soft);
  }
  return sum;
}

void PseudoInverse::fail_rotor(int i) {
  linear_.fail_rotor(i);
  vehicle_.rotors[static_cast<std::size_t>(i)].throttle_lower = 0;
}

void PseudoInverse::stick_servo(int i) {
  linear_.stick_servo(i, previous_[i]);
}

}  // namespace tenon
