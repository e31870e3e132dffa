// What is believed of a vector: a mean and a covariance, to which linear measurements and motions are added one by one.
//
//     v = c x + e,  e ~ N(0, 1):                             s = 1 + c P c',   g = P c'/s,     m += g (v - c m),     P -= s g g'
//     x+ = b + A x + G w + v,  w ~ N(0, I),  v ~ N(0, diag q):     m+ = b + A m,   P+ = A P A' + G G' + diag q
//
// moving_horizon.md, section 3
// [R. E. Kalman, J. Basic Eng. 82 (1960) 35]; values measured one at a time, so that nothing is inverted.
#pragma once

#include "tenon/core/eigen.hpp"

namespace tenon {

class GaussianBelief {
 public:
  GaussianBelief(const Vector& mean_, const Eigen::MatrixXd& covariance_)
      : mean(mean_), covariance(covariance_), gain_(mean_), moved_(covariance_) {}

  Vector mean;
  Eigen::MatrixXd covariance;

  /// Neither allocates.
  void learn(ConstVectorRef c, double value) {
    gain_.noalias() = covariance * c;
    const double s = 1 + c.dot(gain_);
    mean += gain_ * ((value - c.dot(mean)) / s);
    covariance.noalias() -= gain_ * (gain_ / s).transpose();
  }

  /// A motion known about x0 and w0: it leads from there to `next`.
  void move(const Eigen::MatrixXd& a, const Eigen::MatrixXd& g, ConstVectorRef x0, ConstVectorRef w0, ConstVectorRef next,
            ConstVectorRef variance) {
    gain_ = mean - x0;
    mean = next;
    mean.noalias() += a * gain_;
    mean.noalias() -= g * w0;
    moved_.noalias() = a * covariance;
    covariance.noalias() = moved_ * a.transpose();
    covariance.noalias() += g * g.transpose();
    covariance.diagonal() += variance;
  }

 private:
  Vector gain_;
  Eigen::MatrixXd moved_;
};

}  // namespace tenon
