#include "tenon/problems/peg_in_hole/hole_estimator.hpp"

#include <algorithm>
#include <cmath>

#include "tenon/problems/peg_in_hole/channels.hpp"

namespace tenon::peg {

namespace {

constexpr double kInterval = 0.02;  // s: what the evidence and the forgetting speak of
constexpr double kForgetting = 0.985;
constexpr float kNegligible = 20;  // a weight of e^-20
constexpr double kMargin = 1.2;    // of the grid beyond the prior's half width
constexpr double kNear = 2;        // mm above the highest mouth there may be: the estimate begins

Eigen::ArrayXf axis(double middle, double half, int cells) {
  if (cells == 1) return Eigen::ArrayXf::Constant(1, static_cast<float>(middle));
  return Eigen::ArrayXf::LinSpaced(cells, static_cast<float>(middle - kMargin * half), static_cast<float>(middle + kMargin * half));
}

}  // namespace

HoleEstimator::HoleEstimator(const HoleEstimatorOptions& options)
    : options_(options),
      x_(axis(options.prior.middle[0], options.prior.half_width[0], options.cells[0])),
      z_(axis(options.prior.middle[1], options.prior.half_width[1], options.cells[1])),
      phi_(axis(options.prior.middle[2], options.prior.half_width[2], options.cells[2])),
      evidence_(x_.size(), z_.size() * phi_.size()),
      prior_(x_.size(), z_.size() * phi_.size()),
      contacts_(options.geometry, x_),
      weight_(x_.size()),
      least_(evidence_.cols()) {
  const auto distance = [&](float at, int i) {
    const double half = options_.prior.half_width[i];
    return half > 0 ? static_cast<float>(std::pow((at - options_.prior.middle[i]) / half, 2) / 2) : 0.0F;
  };
  for (Eigen::Index c = 0; c < prior_.cols(); ++c) {
    for (Eigen::Index r = 0; r < prior_.rows(); ++r)
      prior_(r, c) = distance(x_[r], 0) + distance(z_[c % z_.size()], 1) + distance(phi_[c / z_.size()], 2);
  }
  reset();
}

int HoleEstimator::num_measurements() const {
  return kMeasurements;
}
std::string HoleEstimator::estimate_name(int i) const {
  return kEstimateNames[static_cast<std::size_t>(i)];
}

void HoleEstimator::reset() {
  evidence_.setZero();
  last_ = -kInterval;
  summarise();
}

void HoleEstimator::update(double t, ConstVectorRef measurements, ConstVectorRef) {
  const double gain = (t - last_) / kInterval;
  last_ = t;
  const double lever = options_.geometry.lever;
  const Vector3d pose = to_millimetres(measurements.segment<3>(kMeasuredPose), lever);
  if (pose[1] > z_.maxCoeff() + kNear) return;
  const Vector3d force(measurements[kMeasuredForce], measurements[kMeasuredForce + 1], 1e3 / lever * measurements[kMeasuredForce + 2]);
  evidence_ *= static_cast<float>(std::pow(kForgetting, gain));
  contacts_.observe(pose, force);
  const float ruled_out = least_.minCoeff() + kNegligible;  // for now: what speaks against it fades
  for (Eigen::Index c = 0; c < evidence_.cols(); ++c) {
    if (least_[c] <= ruled_out) contacts_.add(z_[c % z_.size()], phi_[c / z_.size()], static_cast<float>(gain), evidence_.col(c));
  }
  summarise();
}

void HoleEstimator::summarise() {
  for (Eigen::Index c = 0; c < evidence_.cols(); ++c) least_[c] = (evidence_.col(c) + prior_.col(c)).minCoeff();
  const float least = least_.minCoeff();
  double sum = 0;
  Vector3d first = Vector3d::Zero();
  Matrix3d second = Matrix3d::Zero();
  for (Eigen::Index c = 0; c < evidence_.cols(); ++c) {
    if (least_[c] > least + kNegligible) continue;
    weight_ = (least - evidence_.col(c) - prior_.col(c)).exp();
    const double w = weight_.sum(), wx = (weight_ * x_).sum(), wxx = (weight_ * x_ * x_).sum();
    const double z = z_[c % z_.size()], phi = phi_[c / z_.size()];
    sum += w;
    first += Vector3d(wx, w * z, w * phi);
    Matrix3d moment;
    moment << wxx, 0, 0, wx * z, w * z * z, 0, wx * phi, w * z * phi, w * phi * phi;
    second += moment;
  }
  mean_ = first / sum;
  covariance_ = second / sum - Matrix3d((mean_ * mean_.transpose()).triangularView<Eigen::Lower>());
  for (int i = 0; i < 3; ++i) covariance_(i, i) += options_.least_deviation * options_.least_deviation;
}

void HoleEstimator::mean(VectorRef values) const {
  values = to_si(mean_, options_.geometry.lever);
}

void HoleEstimator::covariance(MatrixRef values) const {
  const Vector3d unit = to_si(Vector3d::Ones(), options_.geometry.lever);
  values = covariance_.cwiseProduct(unit * unit.transpose());
}

}  // namespace tenon::peg
