// An estimator of what is not measured, for those who hold it without knowing which it is.
//
// It says how sure it is: the covariance is part of the answer, and a direction in which nothing was learnt keeps its prior.
#pragma once

#include <string>
#include <vector>

#include "tenon/core/eigen.hpp"

namespace tenon {

using MatrixRef = Eigen::Ref<Eigen::MatrixXd>;

class Estimator {
 public:
  virtual ~Estimator() = default;

  virtual int num_measurements() const = 0;
  virtual int num_estimates() const = 0;

  /// Back to the prior: before every run.
  virtual void reset() = 0;

  /// What was measured at t (s), `commands` what had been commanded until then. Allocates nothing and does not throw.
  virtual void update(double t, ConstVectorRef measurements, ConstVectorRef commands) = 0;

  /// The mean (num_estimates) and the lower triangle of the covariance (square of it), now.
  virtual void mean(VectorRef values) const = 0;
  virtual void covariance(MatrixRef values) const = 0;

  /// Whether estimate i is positive and known in proportion: its deviation then counts relative to its mean.
  virtual bool is_known_in_proportion(int i) const {
    static_cast<void>(i);
    return false;
  }

  virtual std::string estimate_name(int i) const { return "estimate" + std::to_string(i + 1); }
};

/// Of the covariance's lower triangle in a record, column by column.
inline std::vector<std::string> covariance_names(const Estimator& estimator) {
  std::vector<std::string> names;
  for (int column = 0; column < estimator.num_estimates(); ++column) {
    for (int row = column; row < estimator.num_estimates(); ++row)
      names.push_back("cov_" + estimator.estimate_name(column) + "_" + estimator.estimate_name(row));
  }
  return names;
}

}  // namespace tenon
