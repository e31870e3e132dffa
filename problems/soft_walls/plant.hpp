// The pole between the walls as it is: the model without rounding, from a start that may be drawn.
//
//     u_k held over a step  ->  x_{k+1};      success: |x|_inf <= 1e-2 at the end
#pragma once

#include "tenon/core/plant.hpp"
#include "tenon/problems/soft_walls/horizon.hpp"

namespace tenon::soft_walls {

class WallsPlant final : public Plant {
 public:
  /// Each component of the start is uniform within `spread` of it; the weights are those of the cost in the verdicts.
  WallsPlant(const Model& model, const Weights& weights, const State& start, const State& spread);

  int num_commands() const override { return 1; }
  int num_measurements() const override { return 4; }
  void reset(std::uint64_t seed) override;
  void advance(double t_end, ConstVectorRef commands) override;
  void measure(VectorRef values) override { values = x_; }
  bool finished() const override { return !(x_.lpNorm<Eigen::Infinity>() < kLost); }
  int num_outputs() const override { return 7; }
  std::string output_name(int i) const override;
  void outputs(VectorRef values) const override;
  int num_verdicts() const override { return 8; }
  std::string verdict_name(int i) const override;
  void verdicts(VectorRef values) const override;
  std::string severity() const override { return "end"; }
  std::string measurement_name(int i) const override;
  std::string command_name(int) const override { return "u"; }

  const State& state() const { return x_; }

 private:
  static constexpr double kLost = 1e3;

  Model model_;
  Weights weights_;
  State start_, spread_;

  State drawn_ = State::Zero(), x_ = State::Zero();
  long steps_ = 0;
  double cost_ = 0, largest_force_ = 0;
};

}  // namespace tenon::soft_walls
