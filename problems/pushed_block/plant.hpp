// The finger and the block as they are: a block somewhere, of some mass and friction, all drawn from what is believed before.
//
// The world of seed 0 is the one that its scene states, without noise. Forces ripple, drawn once a period.
#pragma once

#include <cstdint>
#include <memory>

#include "tenon/core/plant.hpp"
#include "tenon/core/random.hpp"
#include "tenon/problems/pushed_block/model.hpp"

namespace tenon::pushed_block {

class BlockPlant final : public Plant {
 public:
  /// `stated`: where seed 0 starts.
  BlockPlant(const Parameters& parameters, const Prior& prior, const State& stated);

  int num_commands() const override { return 1; }
  int num_measurements() const override { return 1; }
  void reset(std::uint64_t seed) override;
  void advance(double t_end, ConstVectorRef commands) override;
  void measure(VectorRef values) override;
  bool finished() const override { return false; }
  int num_outputs() const override { return kStates + 1; }
  std::string output_name(int i) const override;
  void outputs(VectorRef values) const override;
  int num_verdicts() const override { return 5; }
  std::string verdict_name(int i) const override;
  void verdicts(VectorRef values) const override;
  std::string severity() const override { return "largest_force"; }
  std::string measurement_name(int) const override { return "measured_finger"; }
  std::string command_name(int) const override { return "force"; }

 private:
  Parameters parameters_;
  Prior prior_;
  State stated_, drawn_, x_;
  std::shared_ptr<const Dae> dae_;
  Dae::Workspace workspace_;
  Random random_{0};
  bool is_noisy_ = false;
  long steps_ = 0;
  double largest_force_ = 0;
};

}  // namespace tenon::pushed_block
