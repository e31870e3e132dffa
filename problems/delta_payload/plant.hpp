// The delta with a payload that nobody weighed: its own dynamics, encoders with noise, motors whose torque ripples.
//
// The world of seed 0 is the one that its scene states, without noise; the others are drawn from what is believed.
#pragma once

#include <cstdint>

#include "tenon/core/plant.hpp"
#include "tenon/core/random.hpp"
#include "tenon/problems/delta/plant.hpp"
#include "tenon/problems/delta_payload/model.hpp"

namespace tenon::delta_payload {

class PayloadPlant final : public Plant {
 public:
  /// `stated`: payload (kg) and damping (N m s) of seed 0. Throws std::invalid_argument as delta::Plant does.
  PayloadPlant(const Parameters& parameters, const Prior& prior, const Eigen::Vector2d& stated);

  int num_commands() const override { return delta::kArms; }
  int num_measurements() const override { return delta::kArms; }
  void reset(std::uint64_t seed) override;
  void advance(double t_end, ConstVectorRef commands) override;
  void measure(VectorRef values) override;
  bool finished() const override { return lost_; }
  int num_outputs() const override { return kStates + 6; }
  std::string output_name(int i) const override;
  void outputs(VectorRef values) const override;
  int num_verdicts() const override { return 4; }
  std::string verdict_name(int i) const override;
  void verdicts(VectorRef values) const override;
  std::string severity() const override { return "largest_torque"; }
  std::string measurement_name(int i) const override { return std::string("measured_") + kStateNames[static_cast<std::size_t>(i)]; }
  std::string command_name(int i) const override { return "torque" + std::to_string(i + 1); }

 private:
  Parameters parameters_;
  Prior prior_;
  Eigen::Vector2d stated_;
  State drawn_;
  delta::Plant robot_;
  Random random_{0};
  bool is_noisy_ = false, lost_ = false;
  double largest_torque_ = 0;
};

}  // namespace tenon::delta_payload
