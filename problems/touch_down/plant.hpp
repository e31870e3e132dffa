// The wrist and the plane as they are: a mass behind an acceleration, and a stiff, damped contact at a height that may be drawn.
//
//     m z'' = m w - lambda,     lambda = max(0, k d + c d'),  d = z - plane,  c = 2 zeta sqrt(k m)
//
// Semi-implicit Euler with steps much shorter than the contact's period.
#pragma once

#include "tenon/core/plant.hpp"

namespace tenon::touch_down {

struct World {
  double mass = 0.6;
  double stiffness = 1e5, damping_ratio = 0.3;
  double start = 0.36;                      // m, at rest
  double plane = 0.42, uncertainty = 2e-3;  // m: the drawn plane is uniform within it
  double wanted_force = 5;
  double duration = 2;
};

class PlanePlant final : public Plant {
 public:
  explicit PlanePlant(const World& world);

  int num_commands() const override { return 1; }
  int num_measurements() const override { return 5; }
  void reset(std::uint64_t seed) override;
  void advance(double t_end, ConstVectorRef commands) override;
  void measure(VectorRef values) override;
  bool finished() const override { return false; }
  int num_outputs() const override { return 5; }
  std::string output_name(int i) const override;
  void outputs(VectorRef values) const override;
  /// Touch, peak, rebound, held force and the time from which it was held.
  int num_verdicts() const override { return 8; }
  std::string verdict_name(int i) const override;
  void verdicts(VectorRef values) const override;
  std::string severity() const override { return "peak_force"; }
  std::string measurement_name(int i) const override;
  std::string command_name(int) const override { return "w"; }

 private:
  void micro_step(double w);
  double contact_force() const;

  World world_;
  double damping_;

  double plane_ = 0, z_ = 0, v_ = 0, w_ = 0;
  long steps_ = 0;
  double tick_peak_ = 0;
  bool touched_ = false;
  double touch_speed_ = 0, peak_ = 0, rebound_ = 0, held_since_ = 0;
};

}  // namespace tenon::touch_down
