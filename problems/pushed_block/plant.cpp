#include "tenon/problems/pushed_block/plant.hpp"

#include <algorithm>
#include <cmath>

namespace tenon::pushed_block {

namespace {

constexpr double kMicroStep = 5e-4;  // s; what is fastest is friction near rest, mu g / v_s = 150 1/s
constexpr double kMoved = 0.01;      // m: a block that was pushed

}  // namespace

BlockPlant::BlockPlant(const Parameters& parameters, const Prior& prior, const State& stated)
    : parameters_(parameters),
      prior_(prior),
      stated_(stated),
      dae_(estimation_problem(parameters, prior, 1).dae),
      workspace_(dae_->make_workspace()) {
  reset(0);
}

void BlockPlant::reset(std::uint64_t seed) {
  random_ = Random(seed);
  is_noisy_ = seed != 0;
  drawn_ = stated_;
  if (is_noisy_) {
    for (int i = 0; i < kStates; ++i) {
      const double change = prior_.deviation[i] * random_.normal(), mean = prior_.mean[i];
      drawn_[i] = i == kBlockMass || i == kFriction ? mean * std::exp(change / mean) : mean + change;
    }
  }
  x_ = drawn_;
  steps_ = 0;
  largest_force_ = 0;
}

void BlockPlant::advance(double t_end, ConstVectorRef commands) {
  State ripple = State::Zero(), rate, middle;
  if (is_noisy_) {
    ripple[kFingerRate] = parameters_.force_ripple / parameters_.finger_mass * random_.normal();
    ripple[kBlockRate] = parameters_.friction_ripple / x_[kBlockMass] * random_.normal();
  }
  Vector none;
  const auto derivatives = [&](const State& x) {
    dae_->derivatives({}, 0, x, commands, workspace_, rate, none);
    rate += ripple;
  };
  for (const long last = std::lround(t_end / kMicroStep); steps_ < last; ++steps_) {
    derivatives(x_);
    middle = x_ + kMicroStep / 2 * rate;
    derivatives(middle);
    x_ += kMicroStep * rate;
    largest_force_ = std::max(largest_force_, contact_force(parameters_, x_));
  }
}

void BlockPlant::measure(VectorRef values) {
  values[0] = x_[kFinger] + (is_noisy_ ? parameters_.noise * random_.normal() : 0.0);
}

std::string BlockPlant::output_name(int i) const {
  return i < kStates ? kStateNames[static_cast<std::size_t>(i)] : "contact_force";
}

void BlockPlant::outputs(VectorRef values) const {
  values << x_, contact_force(parameters_, x_);
}

std::string BlockPlant::verdict_name(int i) const {
  static const char* const kNames[] = {"block_mass", "friction", "success", "moved", "largest_force"};
  return kNames[i];
}

void BlockPlant::verdicts(VectorRef values) const {
  const double moved = x_[kBlock] - drawn_[kBlock];
  values << drawn_[kBlockMass], drawn_[kFriction], moved > kMoved ? 1 : 0, moved, largest_force_;
}

}  // namespace tenon::pushed_block
