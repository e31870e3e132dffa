#include "tenon/problems/allocation/linear_allocation.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "tenon/problems/allocation/inverse_throttle_map.hpp"

namespace tenon {

namespace {

constexpr double kTwoPi = 6.283185307179586;
constexpr double kRankTolerance = 1e-10;   // of the largest eigenvalue of K K'
constexpr double kNoThrust = 1e-12;        // v below which an arm's angle means nothing
constexpr double kDriftTolerance = 1e-14;  // where the passes of (3) end

/// w(d) = [ d ; r x d + s k d ]
Wrench unit_wrench(const Eigen::Vector3d& r, const Eigen::Vector3d& d, double signed_ratio) {
  Wrench w;
  w << d, r.cross(d) + signed_ratio * d;
  return w;
}

}  // namespace

LinearAllocation::LinearAllocation(const Vehicle& vehicle)
    : num_rotors_(vehicle.num_rotors()),
      force_scale_(std::sqrt(vehicle.weights.force_error)),
      torque_scale_(std::sqrt(vehicle.weights.torque_error)) {
  const double hover_thrust = vehicle.mass * vehicle.gravity / num_rotors_;
  for (int i = 0; i < num_rotors_; ++i) {
    const Rotor& rotor = vehicle.rotors[static_cast<std::size_t>(i)];
    Arm& arm = arms_[i];
    arm.kind = rotor.tilt ? Kind::tilting : Kind::fixed;
    arm.position = rotor.position;
    arm.axis = rotor.axis;
    arm.along = rotor.axis.dot(rotor.zero);
    arm.zero = rotor.zero - arm.along * rotor.axis;
    arm.across = rotor.axis.cross(rotor.zero);
    arm.spin = rotor.spin;
    arm.thrust = rotor.thrust;
    arm.torque = rotor.torque;
    arm.throttle_lower = rotor.throttle_lower;
    arm.throttle_upper = rotor.throttle_upper;
    arm.linear_thrust = rotor.thrust[0] == 0 && std::all_of(rotor.thrust.begin() + std::min<std::ptrdiff_t>(2, std::ssize(rotor.thrust)),
                                                            rotor.thrust.end(), [](double c) { return c == 0; });
    const double lowest = rotor.throttle_lower + 0.1 * (rotor.throttle_upper - rotor.throttle_lower);
    double hover = std::clamp(throttle_of(arm, hover_thrust), lowest, rotor.throttle_upper);
    if (std::abs(hover) < 1e-3) hover = rotor.throttle_upper;
    arm.kappa = arm.linear_thrust ? rotor.thrust[1] : throttle_map(rotor.thrust, hover) / hover;
    arm.torque_ratio = throttle_map(rotor.torque, hover) / throttle_map(rotor.thrust, hover);
  }
  factor();
}

void LinearAllocation::factor() {
  // K, unknowns c_1, s_1, c_2, ...; the column of an absent unknown is 0, which keeps it at 0.
  Eigen::Matrix<double, 6, 2 * kMaxRotors> K;
  Eigen::Matrix<double, 6, kMaxRotors> Q;
  K.setZero();
  Q.setZero();
  for (int i = 0; i < num_rotors_; ++i) {
    const Arm& arm = arms_[i];
    const double ratio = arm.spin * arm.torque_ratio;
    if (arm.kind == Kind::tilting) {
      K.col(2 * i) = arm.kappa * unit_wrench(arm.position, arm.zero, ratio);
      K.col(2 * i + 1) = arm.kappa * unit_wrench(arm.position, arm.across, ratio);
      Q.col(i) = arm.kappa * arm.along * unit_wrench(arm.position, arm.axis, ratio);
    } else if (arm.kind == Kind::fixed) {
      const Eigen::Vector3d n = arm.along * arm.axis + std::cos(arm.angle) * arm.zero + std::sin(arm.angle) * arm.across;
      K.col(2 * i) = arm.kappa * unit_wrench(arm.position, n, ratio);
    }
  }
  Wrench scale;
  scale << force_scale_, force_scale_, force_scale_, torque_scale_, torque_scale_, torque_scale_;

  // S K K' S = V diag(e) V';  (K K')^+ = S V diag(1/e) V' S over the eigenvalues that are not 0
  const Eigen::Matrix<double, 6, 6> gram = scale.asDiagonal() * (K * K.transpose()) * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> eigen(gram);
  const Wrench values = eigen.eigenvalues();  // ascending
  Wrench inverse_values = Wrench::Zero();
  rank_ = 0;
  for (int k = 0; k < 6; ++k) {
    if (!(values[k] > kRankTolerance * values[5])) continue;
    inverse_values[k] = 1 / values[k];
    ++rank_;
  }
  const Eigen::Matrix<double, 6, 6> SV = scale.asDiagonal() * eigen.eigenvectors();
  effort_ = SV * inverse_values.asDiagonal() * SV.transpose();
  null_ = SV;
  inverse_ = K.transpose() * effort_;
  drift_ = inverse_ * Q;

  const double contraction = std::min(0.9, drift_.cwiseAbs().rowwise().sum().maxCoeff());
  constexpr int kMaxCorrections = 50;
  corrections_ = contraction < kDriftTolerance
                     ? 0
                     : std::min(kMaxCorrections, static_cast<int>(std::ceil(std::log(kDriftTolerance) / std::log(contraction))));
}

void LinearAllocation::solve(const Wrench& wrench, ConstVectorRef previous_angles, VectorRef u, VectorRef a) const {
  // (1)  [c; s] = K^+ W
  const Pairs start = inverse_ * wrench;
  Pairs pairs = start;
  Eigen::Matrix<double, kMaxRotors, 1> v;
  const auto lengths = [&] {
    for (int i = 0; i < kMaxRotors; ++i) v[i] = std::sqrt(pairs[2 * i] * pairs[2 * i] + pairs[2 * i + 1] * pairs[2 * i + 1]);
  };
  lengths();
  for (int k = 0; k < corrections_; ++k) {
    pairs = start - drift_ * v;  // (3)
    lengths();
  }
  // (2)  u = thrust^-1(kappa v),  a = atan2(s, c)
  for (int i = 0; i < num_rotors_; ++i) {
    const Arm& arm = arms_[i];
    const double c = pairs[2 * i], s = pairs[2 * i + 1];
    if (arm.kind == Kind::tilting) {
      u[i] = arm.linear_thrust ? v[i] : throttle_of(arm, arm.kappa * v[i]);
      const double turn = v[i] > kNoThrust ? std::atan2(s, c) - previous_angles[i] : 0;
      a[i] = previous_angles[i] + (turn - kTwoPi * std::nearbyint(turn / kTwoPi));
    } else {
      u[i] = arm.kind == Kind::failed ? 0 : throttle_of(arm, arm.kappa * c);
      a[i] = arm.kind == Kind::fixed ? arm.angle : previous_angles[i];
    }
  }
}

double LinearAllocation::throttle_of(const Arm& arm, double thrust) const {
  if (arm.linear_thrust) return thrust / arm.thrust[1];
  const double lower = arm.throttle_lower, upper = arm.throttle_upper;
  const double weakest = throttle_map(arm.thrust, lower), strongest = throttle_map(arm.thrust, upper);
  const double secant = (strongest - weakest) / (upper - lower);
  if (thrust >= strongest) return upper + (thrust - strongest) / secant;
  if (thrust <= weakest) return lower + (thrust - weakest) / secant;
  if (arm.thrust.size() == 3) {
    // c0 + c1 u + c2 u^2 = f on the branch that rises:  u = 2 (f - c0) / (c1 + sqrt(c1^2 + 4 c2 (f - c0)))
    const double rise = thrust - arm.thrust[0], slope = arm.thrust[1];
    const double u = 2 * rise / (slope + std::sqrt(slope * slope + 4 * arm.thrust[2] * rise));
    if (u >= lower && u <= upper) return u;
  }
  return inverse_throttle_map(arm.thrust, thrust, lower, upper);
}

Wrench LinearAllocation::wrench(ConstVectorRef u, ConstVectorRef a) const {
  Wrench sum = Wrench::Zero();
  for (int i = 0; i < num_rotors_; ++i) {
    const Arm& arm = arms_[i];
    if (arm.kind == Kind::failed) continue;
    const Eigen::Vector3d n = arm.along * arm.axis + std::cos(a[i]) * arm.zero + std::sin(a[i]) * arm.across;
    const Eigen::Vector3d force = throttle_map(arm.thrust, u[i]) * n;
    sum.head<3>() += force;
    sum.tail<3>() += arm.position.cross(force) + arm.spin * throttle_map(arm.torque, u[i]) * n;
  }
  return sum;
}

void LinearAllocation::fail_rotor(int i) {
  arms_[i].kind = Kind::failed;
  factor();
}

void LinearAllocation::stick_servo(int i, double angle) {
  if (arms_[i].kind != Kind::tilting) return;
  arms_[i].kind = Kind::fixed;
  arms_[i].angle = angle;
  factor();
}

bool LinearAllocation::has_linear_thrust() const {
  return std::all_of(arms_, arms_ + num_rotors_, [](const Arm& arm) { return arm.linear_thrust; });
}

std::vector<std::string> LinearAllocation::unreachable_directions() const {
  static constexpr const char* kNames[6] = {"force along body x",  "force along body y",  "force along body z",
                                            "torque about body x", "torque about body y", "torque about body z"};
  static constexpr const char* kShort[6] = {"Fx", "Fy", "Fz", "Mx", "My", "Mz"};
  // The null space has no basis of its own: bring it to reduced row echelon form, so that a plain axis shows as one.
  Eigen::MatrixXd basis = null_.leftCols(6 - rank_).transpose();
  Eigen::Index row = 0;
  for (Eigen::Index col = 0; col < 6 && row < basis.rows(); ++col) {
    Eigen::Index pivot = 0;
    if (basis.col(col).tail(basis.rows() - row).cwiseAbs().maxCoeff(&pivot) < 1e-6 * basis.cwiseAbs().maxCoeff()) continue;
    basis.row(row).swap(basis.row(row + pivot));
    basis.row(row) /= basis(row, col);
    for (Eigen::Index r = 0; r < basis.rows(); ++r) {
      if (r != row) basis.row(r) -= (basis(r, col) * basis.row(row)).eval();
    }
    ++row;
  }
  std::vector<std::string> directions;
  for (Eigen::Index r = 0; r < basis.rows(); ++r) {
    std::string text;
    int terms = 0, last = 0;
    for (int k = 0; k < 6; ++k) {
      const double share = basis(r, k);
      if (std::abs(share) < 1e-6 * basis.row(r).cwiseAbs().maxCoeff()) continue;
      text += fmt::format("{}{:.3g} {}", terms == 0 ? (share < 0 ? "-" : "") : (share < 0 ? " - " : " + "), std::abs(share), kShort[k]);
      ++terms;
      last = k;
    }
    directions.push_back(terms == 1 ? kNames[last] : text);
  }
  return directions;
}

}  // namespace tenon
