#include "tenon/problems/soft_walls/plant.hpp"

#include <algorithm>
#include <cmath>

#include "tenon/core/random.hpp"

namespace tenon::soft_walls {

namespace {

const char* const kStateNames[] = {"x", "theta", "v", "omega"};
constexpr double kArrived = 1e-2;

}  // namespace

WallsPlant::WallsPlant(const Model& model, const Weights& weights, const State& start, const State& spread)
    : model_(model), weights_(weights), start_(start), spread_(spread) {
  reset(0);
}

void WallsPlant::reset(std::uint64_t seed) {
  drawn_ = start_;
  if (seed != 0) {
    Random random(seed);
    for (int i = 0; i < 4; ++i) drawn_[i] += random.uniform(-spread_[i], spread_[i]);
  }
  x_ = drawn_;
  steps_ = 0;
  cost_ = largest_force_ = 0;
}

void WallsPlant::advance(double t_end, ConstVectorRef commands) {
  const double u = commands[0];
  while (static_cast<double>(steps_ + 1) * model_.parameters().step < t_end * (1 + 1e-9)) {
    cost_ += x_.cwiseAbs2().dot(weights_.state) + weights_.input * u * u;
    largest_force_ = std::max(largest_force_, std::abs(model_.wall_force(model_.tip().dot(x_))));
    x_ = model_.next(x_, u);
    ++steps_;
  }
}

std::string WallsPlant::output_name(int i) const {
  static const char* const kNames[] = {"tip", "lambda_right", "lambda_left"};
  return i < 4 ? kStateNames[i] : kNames[i - 4];
}

void WallsPlant::outputs(VectorRef values) const {
  const double tip = model_.tip().dot(x_), force = model_.wall_force(tip);
  values << x_, tip, std::max(0.0, force), std::max(0.0, -force);
}

std::string WallsPlant::verdict_name(int i) const {
  static const char* const kNames[] = {"success", "end", "cost", "largest_force"};
  return i < 4 ? std::string("start_") + kStateNames[i] : kNames[i - 4];
}

void WallsPlant::verdicts(VectorRef values) const {
  const double end = x_.lpNorm<Eigen::Infinity>();
  values << drawn_, end <= kArrived ? 1 : 0, end, cost_, largest_force_;
}

std::string WallsPlant::measurement_name(int i) const {
  return std::string("measured_") + kStateNames[i];
}

}  // namespace tenon::soft_walls
