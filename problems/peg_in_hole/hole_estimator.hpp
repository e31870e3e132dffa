// Where the hole is, from where the peg could be and what pushed it there: Bayes' rule on a grid over (x, z, theta) of its mouth.
//
//     log w  +=  -gain e,     e: ContactEvidence's, gain = ticks of 20 ms
//
// Old evidence fades, the prior does not. Equations: peg_in_hole.md, section 4.
#pragma once

#include "tenon/core/estimator.hpp"
#include "tenon/problems/peg_in_hole/contact_evidence.hpp"
#include "tenon/problems/peg_in_hole/plant.hpp"

namespace tenon::peg {

struct HoleEstimatorOptions {
  Geometry geometry;
  HolePrior prior;
  Eigen::Array3i cells{61, 1, 31};  // x, z, theta
  double least_deviation = 0.02;    // mm: never surer than this
};

class HoleEstimator final : public Estimator {
 public:
  explicit HoleEstimator(const HoleEstimatorOptions& options);

  int num_measurements() const override;
  int num_estimates() const override { return 3; }
  void reset() override;
  void update(double t, ConstVectorRef measurements, ConstVectorRef commands) override;
  void mean(VectorRef values) const override;
  void covariance(MatrixRef values) const override;
  std::string estimate_name(int i) const override;

 private:
  void summarise();

  HoleEstimatorOptions options_;
  Eigen::ArrayXf x_, z_, phi_;  // mm, the middle of the cells
  Eigen::ArrayXXf evidence_;    // against a cell; columns: x, all z of the first phi, all z of the next ...
  Eigen::ArrayXXf prior_;
  ContactEvidence contacts_;
  Eigen::ArrayXf weight_;  // of one column
  Eigen::ArrayXf least_;   // of each column: what speaks against its best place
  Vector3d mean_;
  Matrix3d covariance_;
  double last_ = 0;
};

}  // namespace tenon::peg
