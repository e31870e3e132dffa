// Tracking:  f(z) = 1/2 sum_i w_i (z_i - r_i)^2.
#pragma once

#include <utility>

#include "tenon/core/smooth_function.hpp"

namespace tenon {

class WeightedSquares final : public SmoothFunction {
 public:
  /// Both of the same length n; weights >= 0.
  WeightedSquares(Vector weights, Vector reference) : weights_(std::move(weights)), reference_(std::move(reference)) {}

  int num_arguments() const override { return static_cast<int>(weights_.size()); }
  int num_values() const override { return 1; }

  void values(ConstVectorRef z, VectorRef f) const override { f[0] = 0.5 * (weights_.array() * (z - reference_).array().square()).sum(); }
  void jacobian(ConstVectorRef z, Matrix jacobian) const override {
    jacobian.row(0) = (weights_.array() * (z - reference_).array()).matrix().transpose();
  }
  void hessian(ConstVectorRef, ConstVectorRef weights, Matrix hessian) const override {
    hessian.setZero();
    hessian.diagonal() = weights[0] * weights_;
  }

 private:
  Vector weights_, reference_;
};

}  // namespace tenon
