#include "tenon/apps/benchmark/textbook_allocation.hpp"

#include <chrono>
#include <utility>

namespace tenon {

namespace {

constexpr double kMostThrottleStep = 0.05, kMostAngleStep = 0.05, kTolerance = 1e-3;  // du_max, da_max, tol
constexpr int kMostIterations = 16;

Vehicle with_soft_limits(Vehicle vehicle) {
  vehicle.hard_limits = false;
  return vehicle;
}

}  // namespace

TextbookAllocator::TextbookAllocator(Vehicle vehicle) : linear_(vehicle), problem_(with_soft_limits(std::move(vehicle))) {
  for (Vector* v : {&u_linear_, &a_linear_, &previous_, &out_.throttle, &out_.angle}) v->setZero(kRotors);
}

void TextbookAllocator::reset(ConstVectorRef angles) {
  previous_ = angles;
  has_previous_ = true;
  has_point_ = false;
}

void TextbookAllocator::fail_rotor(int i) {
  linear_.fail_rotor(i);
  problem_.fail_rotor(i);
}

void TextbookAllocator::stick_servo(int i) {
  linear_.stick_servo(i, previous_[i]);
  problem_.stick_servo(i, previous_[i]);
}

const Allocation& TextbookAllocator::allocate(const Wrench& wrench, double dt) {
  const auto begin = std::chrono::steady_clock::now();
  problem_.set_wrench(wrench);
  if (has_previous_) problem_.set_previous(previous_.array(), dt);
  else problem_.forget_previous();
  const auto start_at_linear = [&] {
    linear_.solve(wrench, previous_, u_linear_, a_linear_);
    point_.x << u_linear_, a_linear_;
    point_.lambda = linear_.effort_multipliers(wrench);
  };
  if (!has_previous_ || !has_point_) start_at_linear();
  out_.iterations = 0;
  has_point_ = iterate();
  if (!has_point_) {
    start_at_linear();
    evaluate();
  }
  out_.status = has_point_ ? AllocationStatus::solved : AllocationStatus::fallback;
  out_.throttle = point_.x.head<kRotors>();
  out_.angle = point_.x.tail<kRotors>();
  out_.error = g_;
  out_.objective = objective_;
  previous_ = out_.angle;
  has_previous_ = true;
  out_.elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  // for the record, outside the clock
  problem_.jacobian(point_.x, at_, jacobian_);
  problem_.gradient(point_.x, at_, gradient_);
  out_.residual = std::max((gradient_ + jacobian_.transpose() * point_.lambda).lpNorm<Eigen::Infinity>(), g_.lpNorm<Eigen::Infinity>());
  return out_;
}

bool TextbookAllocator::iterate() {
  evaluate();
  while (out_.iterations < kMostIterations) {
    const double before = objective_;
    step();
    evaluate();
    ++out_.iterations;
    if (!point_.x.allFinite()) return false;
    if (g_.norm() < kTolerance && std::abs(before - objective_) / before < kTolerance) return true;
  }
  return false;
}

void TextbookAllocator::evaluate() {
  problem_.prepare(point_.x, at_);
  objective_ = problem_.objective(point_.x, at_);
  problem_.constraints(point_.x, at_, g_);
}

void TextbookAllocator::step() {
  problem_.gradient(point_.x, at_, gradient_);
  problem_.jacobian(point_.x, at_, jacobian_);
  problem_.hessian(point_.x, 1, point_.lambda, at_, hessian_);
  k_.setZero();
  for (int i = 0; i < kRotors; ++i) {
    k_(i, i) = hessian_.uu[i];
    k_(kRotors + i, i) = k_(i, kRotors + i) = hessian_.au[i];
    k_(kRotors + i, kRotors + i) = hessian_.aa[i];
  }
  k_.bottomLeftCorner<6, 2 * kRotors>() = jacobian_;
  k_.topRightCorner<2 * kRotors, 6>() = jacobian_.transpose();
  rhs_ << -gradient_, -g_;
  ldlt_.compute(k_);
  rhs_ = ldlt_.solve(rhs_).eval();
  const double du = rhs_.head<kRotors>().lpNorm<Eigen::Infinity>(), da = rhs_.segment<kRotors>(kRotors).lpNorm<Eigen::Infinity>();
  const double factor = std::min({1.0, kMostThrottleStep / du, kMostAngleStep / da});
  point_.x += factor * rhs_.head<2 * kRotors>();
  point_.lambda += factor * (rhs_.tail<6>() - point_.lambda);
}

}  // namespace tenon
