#include "tenon/problems/peg_in_hole/hole_estimator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "tenon/problems/peg_in_hole/channels.hpp"

namespace tenon::peg {

namespace {

constexpr double kInterval = 0.02;   // s: what sigma and the forgetting speak of
constexpr double kForgetting = 0.985;
constexpr double kMargin = 1.2;      // of the grid beyond the prior's half width
constexpr double kNear = 2;          // mm above the highest mouth there may be: the estimate begins
constexpr double kTouch = 0.7, kSideways = 0.4, kTurning = 0.3;  // N: a touch; which side it is on, by force, by moment / lever
constexpr double kPushWeight = 0.3, kFar = 0.5;                  // mm
constexpr double kLargestFriction = 0.5, kLargestResidual = 1;   // beyond it a force is not of that face; N
constexpr double kJammedFriction = 1, kJammedResidual = 0.3;     // the same on a wall, where the one opposite may add its own; N
constexpr double kForceDeviation = 0.5;                          // N

Eigen::ArrayXf axis(double middle, double half, int cells) {
  if (cells == 1) return Eigen::ArrayXf::Constant(1, static_cast<float>(middle));
  return Eigen::ArrayXf::LinSpaced(cells, static_cast<float>(middle - kMargin * half), static_cast<float>(middle + kMargin * half));
}

/// +1 where the right block pushes, -1 the left one, 0 where nobody does or nobody knows which.
int pushing_side(const Vector3d& force) {
  if (force.head<2>().norm() < kTouch) return 0;
  if (std::abs(force[0]) > kSideways) return force[0] > 0 ? -1 : 1;
  if (std::abs(force[2]) > kTurning) return force[2] > 0 ? 1 : -1;
  return 0;
}

/// N: what of a push along a face its friction cannot account for, given the push at right angles to it.
float beyond_friction(float normal, float tangential, double friction = kLargestFriction, double largest = kLargestResidual) {
  const float residual = std::abs(tangential) - static_cast<float>(friction) * std::max(normal, 0.0F);
  return std::clamp(residual, 0.0F, static_cast<float>(largest));
}

}  // namespace

HoleEstimator::HoleEstimator(const HoleEstimatorOptions& options)
    : options_(options),
      x_(axis(options.prior.middle[0], options.prior.half_width[0], options.cells[0])),
      z_(axis(options.prior.middle[1], options.prior.half_width[1], options.cells[1])),
      phi_(axis(options.prior.middle[2], options.prior.half_width[2], options.cells[2])),
      evidence_(x_.size(), z_.size() * phi_.size()),
      prior_(x_.size(), z_.size() * phi_.size()),
      left_(x_.size()),
      right_(x_.size()),
      direction_(x_.size()),
      weight_(x_.size()) {
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
  weigh(pose, force, gain);
  summarise();
}

// Every face of geometry.hpp is linear in the hole's x, so that a column of the grid is a loop without branches.
void HoleEstimator::weigh(const Vector3d& pose, const Vector3d& force, double gain) {
  const Geometry& g = options_.geometry;
  const auto half = static_cast<float>(g.half_opening()), chamfer = static_cast<float>(g.chamfer), width = static_cast<float>(g.width);
  const auto scale = static_cast<float>(gain / (2 * options_.sigma * options_.sigma));
  const double theta = pose[2] / g.lever;
  const auto c = static_cast<float>(std::cos(theta)), s = static_cast<float>(std::sin(theta));
  const auto px = static_cast<float>(pose[0]), pz = static_cast<float>(pose[1]);
  constexpr auto kDiagonal = static_cast<float>(1 / std::numbers::sqrt2);
  const int side = pushing_side(force);
  const auto push_scale = static_cast<float>(gain / (2 * kForceDeviation * kForceDeviation));

  for (Eigen::Index p = 0; p < phi_.size(); ++p) {
    const float theta_h = phi_[p] / static_cast<float>(g.lever), ch = std::cos(theta_h), sh = std::sin(theta_h);
    const float fx = ch * static_cast<float>(force[0]) + sh * static_cast<float>(force[1]);
    const float fz = ch * static_cast<float>(force[1]) - sh * static_cast<float>(force[0]);
    const float against_flat = beyond_friction(fz, fx);
    const float against_chamfer =
        beyond_friction((fz - static_cast<float>(side) * fx) * kDiagonal, (fx + static_cast<float>(side) * fz) * kDiagonal);
    const float against_wall = beyond_friction(-static_cast<float>(side) * fx, fz, kJammedFriction, kJammedResidual);
    for (Eigen::Index h = 0; h < z_.size(); ++h) {
      for (const float r : {-1.0F, 1.0F}) {
        const float corner_x = px + r * c * width / 2, corner_z = pz + r * s * width / 2 - z_[h];
        // vertices of the block, turned and from the peg's middle, but for the hole's x
        const float low_x = ch * r * half + sh * chamfer - px, low_z = sh * r * half - ch * chamfer + z_[h] - pz;
        const float high_x = ch * r * (half + chamfer) - px, high_z = sh * r * (half + chamfer) + z_[h] - pz;
        float* out = r < 0 ? left_.data() : right_.data();
        for (Eigen::Index i = 0; i < x_.size(); ++i) {
          const float hx = r * (ch * (corner_x - x_[i]) + sh * corner_z), hz = ch * corner_z - sh * (corner_x - x_[i]);
          const float slope = (half + chamfer - hx + hz) * kDiagonal, corner = std::max(std::max(half - hx, slope), hz);
          const float low_bx = c * (low_x + x_[i]) + s * low_z, low_bz = c * low_z - s * (low_x + x_[i]);
          const float high_bx = c * (high_x + x_[i]) + s * high_z, high_bz = c * high_z - s * (high_x + x_[i]);
          const float low = std::max(r * low_bx - width / 2, -low_bz), high = std::max(r * high_bx - width / 2, -high_bz);
          out[i] = std::min(corner, std::min(low, high));
          if (r == static_cast<float>(side))  // which face is the corner on?
            direction_[i] = corner > out[i] ? 0 : hz == corner ? against_flat : slope == corner ? against_chamfer : against_wall;
        }
      }
      auto against = evidence_.col(p * z_.size() + h);
      against += scale * left_.min(right_).min(0.0F).square();
      if (side != 0) {
        against += scale * static_cast<float>(kPushWeight) * (side < 0 ? left_ : right_).max(0.0F).min(static_cast<float>(kFar)).square();
        against += push_scale * direction_.square();
      }
    }
  }
}

void HoleEstimator::summarise() {
  float least = std::numeric_limits<float>::infinity();
  for (Eigen::Index c = 0; c < evidence_.cols(); ++c) least = std::min(least, (evidence_.col(c) + prior_.col(c)).minCoeff());
  double sum = 0;
  Vector3d first = Vector3d::Zero();
  Matrix3d second = Matrix3d::Zero();
  for (Eigen::Index c = 0; c < evidence_.cols(); ++c) {
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
