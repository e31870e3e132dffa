// A 2x2 matrix that is a sum of terms of very different size, and its inverse without cancellation.
//
//     H = alpha I + sum_j beta_j s_j s_j',      adj H = alpha I + sum_j beta_j p_j p_j',   p_j = s_j turned by a right angle
//     det H = alpha^2 + alpha sum_j beta_j |s_j|^2 + sum_{j<k} beta_j beta_k (s_j x s_k)^2
//
// Every term is positive where alpha and all beta are: the formula of Cauchy and Binet.
#pragma once

#include <cmath>

#include "tenon/core/eigen.hpp"

namespace tenon {

class RankOneSum {
 public:
  void add_identity(double alpha) {
    determinant_ += alpha * (alpha + 2 * alpha_ + squares_);
    alpha_ += alpha;
    adjugate_.diagonal().array() += alpha;
  }
  void add(double beta, const Eigen::Vector2d& s) {
    const Eigen::Vector2d across(-s[1], s[0]);
    determinant_ += beta * across.dot(outer_ * across) + alpha_ * beta * s.squaredNorm();
    outer_ += beta * s * s.transpose();
    squares_ += beta * s.squaredNorm();
    adjugate_ += beta * across * across.transpose();
  }
  /// L with L L' = H^-1, lower triangular.
  Eigen::Matrix2d inverse_root() const {
    const double first = std::sqrt(adjugate_(0, 0) / determinant_);
    return Eigen::Matrix2d{{first, 0}, {adjugate_(1, 0) / (determinant_ * first), 1 / std::sqrt(adjugate_(0, 0))}};
  }

 private:
  double alpha_ = 0, squares_ = 0, determinant_ = 0;  // squares: sum_j beta_j |s_j|^2
  Eigen::Matrix2d outer_ = Eigen::Matrix2d::Zero(), adjugate_ = Eigen::Matrix2d::Zero();
};

}  // namespace tenon
