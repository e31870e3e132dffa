// Where the plane is, as far as it can be known, and whether to press: aim at the nearest plausible plane and creep, ask for force only
// after contact was felt.
//
//     not felt:  z_p = max(nearest, z + margin),  F = 0             (the gap's pole p makes the margin a speed, p margin)
//     felt:      z_p = z while there is force, else max(z_p, z + little),  F = wanted
//
// Felt is latched, by the peak of the force within a tick: a light tap averages to nothing over one.
#pragma once

#include "tenon/core/estimator.hpp"

namespace tenon::touch_down {

struct PlaneKnowledge {
  double plane = 0.42, uncertainty = 2e-3;  // m: nominal, and to either side
  double margin = 5e-4;                     // m: how far ahead a plane not yet met is believed
  double force = 5;                         // N: wanted once it is met
  double threshold = 0.3;                   // N: what counts as felt
};

class PlaneEstimator final : public Estimator {
 public:
  explicit PlaneEstimator(const PlaneKnowledge& knowledge) : knowledge_(knowledge) { reset(); }

  int num_measurements() const override { return 5; }
  int num_estimates() const override { return 2; }
  void reset() override;
  void update(double t, ConstVectorRef measurements, ConstVectorRef commands) override;
  void mean(VectorRef values) const override { values << plane_, felt_ ? knowledge_.force : 0; }
  /// Of the plane: a uniform range before it was felt, less what has been passed; 0 for the force, which is a decision.
  void covariance(MatrixRef values) const override;
  std::string estimate_name(int i) const override { return i == 0 ? "plane_believed" : "force_wanted"; }

 private:
  PlaneKnowledge knowledge_;
  double plane_ = 0, passed_ = 0;  // m: believed; the deepest position reached
  bool felt_ = false;
};

}  // namespace tenon::touch_down
