#include "tenon/problems/allocation/wrench_sequences.hpp"

#include <algorithm>
#include <cmath>

#include "tenon/problems/allocation/linear_allocation.hpp"

namespace tenon {

namespace {

constexpr double kMostForce = 10, kMostTorque = 1.5;  // N, N m, beside the weight
constexpr double kMostStray = 0.2;                    // rad
constexpr double kTurnStep = 0.01, kForceStep = 0.1, kTorqueStep = 0.02;

Wrench joined(const Eigen::Vector3d& force, const Eigen::Vector3d& torque) {
  return (Wrench() << force, torque).finished();
}

/// Columns: the first rotor's axis, the other axis nearest to a right angle with it made orthogonal, their normal.
Eigen::Matrix3d arm_frame(const Vehicle& vehicle) {
  const Eigen::Vector3d first = vehicle.rotors.front().axis;
  const auto across = [&](const Eigen::Vector3d& axis) { return (axis - axis.dot(first) * first).eval(); };
  Eigen::Vector3d second = across(std::abs(first.z()) < 0.9 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitX());
  const auto nearest = std::ranges::max_element(
      vehicle.rotors, {}, [&](const Rotor& rotor) { return rotor.tilt ? std::round(1e3 * across(rotor.axis).norm()) : 0.0; });
  if (across(nearest->axis).norm() > 1e-3) second = across(nearest->axis);
  second.normalize();
  Eigen::Matrix3d frame;
  frame << first, second, first.cross(second);
  return frame;
}

/// A path on the unit sphere, at even speed with soft corners.
class Path {
 public:
  explicit Path(const Eigen::Vector3d& start) : points_{start} {}

  const Eigen::Vector3d& end() const { return points_.back(); }

  /// Round the (unit) axis by an angle, in points of one degree.
  void turn(const Eigen::Vector3d& axis, double angle) {
    const int pieces = std::max(1, static_cast<int>(std::ceil(std::abs(angle) / kGrain)));
    const Eigen::Vector3d from = end();
    for (int k = 1; k <= pieces; ++k) points_.push_back(Eigen::AngleAxisd(angle * k / pieces, axis) * from);
  }

  void go_to(const Eigen::Vector3d& there) {
    const Eigen::Vector3d axis = end().cross(there);
    if (axis.norm() > 1e-12) turn(axis.normalized(), std::atan2(axis.norm(), end().dot(there)));
  }

  /// At `rows` even shares of its length, the corners rounded by two passes of an average over some 15 degrees.
  std::vector<Eigen::Vector3d> sample(int rows) const {
    std::vector<double> length(points_.size(), 0);
    for (std::size_t k = 1; k < points_.size(); ++k) length[k] = length[k - 1] + (points_[k] - points_[k - 1]).norm();
    const auto at = [&](double s) {
      s = std::clamp(s, 0.0, length.back());
      const auto next = std::ranges::upper_bound(length, s);
      if (next == length.end()) return points_.back();
      const auto k = static_cast<std::size_t>(next - length.begin());
      return ((points_[k - 1] * (length[k] - s) + points_[k] * (s - length[k - 1])) / (length[k] - length[k - 1])).eval();
    };
    std::vector<Eigen::Vector3d> out;
    for (int row = 0; row < rows; ++row) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (int k = -kBlur; k <= kBlur; ++k) {
        sum += (kBlur + 1 - std::abs(k)) * at(length.back() * row / std::max(1, rows - 1) + 0.13 / kBlur * k);
      }
      out.push_back(sum.normalized());
    }
    return out;
  }

 private:
  static constexpr double kGrain = M_PI / 180;
  static constexpr int kBlur = 8;

  std::vector<Eigen::Vector3d> points_;
};

}  // namespace

Eigen::Vector3d RandomNumbers::direction() {
  const double z = uniform(-1, 1), azimuth = uniform(0, 2 * M_PI), across = std::sqrt(std::max(0.0, 1 - z * z));
  return {across * std::cos(azimuth), across * std::sin(azimuth), z};
}

Eigen::Vector3d RandomNumbers::in_ball(double radius) {
  const double distance = radius * std::cbrt(uniform(0, 1));
  return distance * direction();
}

Eigen::Quaterniond RandomNumbers::orientation() {
  Eigen::Vector4d q;
  do {
    for (double& v : q) v = uniform(-1, 1);
  } while (q.squaredNorm() > 1 || q.squaredNorm() < 1e-6);
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized();
}

std::vector<Wrench> hover_sweep(const Vehicle& vehicle, int rows) {
  const Eigen::Matrix3d frame = arm_frame(vehicle);
  const auto of_arms = [&](double x, double y, double z) { return (frame * Eigen::Vector3d(x, y, z).normalized()).eval(); };
  Path path(Eigen::Vector3d::UnitZ());
  path.go_to(of_arms(1, 0, 1));
  path.turn(frame.col(1), 2 * M_PI);
  path.go_to(of_arms(1, 1, 0));
  path.turn(frame.col(2), 2 * M_PI);
  path.go_to(of_arms(0, 1, 1));
  path.turn(frame.col(0), 2 * M_PI);

  // from upside down to level: nine turns about the body's vertical
  constexpr int kTurns = 9, kPoints = 360 * kTurns;
  for (int k = 0; k <= kPoints; ++k) {
    const double height = std::cos(M_PI * (1 - double(k) / kPoints)), azimuth = 2 * M_PI * kTurns * k / kPoints;
    const double across = std::sqrt(std::max(0.0, 1 - height * height));
    path.go_to({across * std::cos(azimuth), across * std::sin(azimuth), height});
  }

  std::vector<Wrench> wrenches;
  for (const Eigen::Vector3d& up : path.sample(rows)) {
    wrenches.push_back(joined(vehicle.mass * vehicle.gravity * up, Eigen::Vector3d::Zero()));
  }
  return wrenches;
}

std::vector<Wrench> with_noise(std::vector<Wrench> wrenches, double force, double torque, std::uint64_t seed) {
  RandomNumbers random(seed);
  for (Wrench& wrench : wrenches) {
    for (int i = 0; i < 6; ++i) wrench[i] += (i < 3 ? force : torque) * random.normal();
  }
  return wrenches;
}

std::vector<Wrench> random_walk(const Vehicle& vehicle, int rows, std::uint64_t seed) {
  RandomNumbers random(seed);
  Eigen::Quaterniond attitude = Eigen::Quaterniond::Identity();
  Eigen::Vector3d force = Eigen::Vector3d::Zero(), torque = force;
  const auto step = [&](double size) {
    Eigen::Vector3d out;
    for (double& v : out) v = size * random.normal();
    return out;
  };
  const auto walk = [&](Eigen::Vector3d& v, double size, double most) {
    v += step(size);
    if (v.norm() > most) v *= most / v.norm();
  };
  std::vector<Wrench> wrenches;
  for (int row = 0; row < rows; ++row) {
    wrenches.push_back(joined(attitude.conjugate() * Eigen::Vector3d(0, 0, vehicle.mass * vehicle.gravity) + force, torque));
    const Eigen::Vector3d turn = step(kTurnStep);
    attitude = (attitude * Eigen::Quaterniond(Eigen::AngleAxisd(turn.norm(), turn.normalized()))).normalized();
    walk(force, kForceStep, kMostForce);
    walk(torque, kTorqueStep, kMostTorque);
  }
  return wrenches;
}

std::vector<RandomRow> random_rows(const Vehicle& vehicle, int rows, std::uint64_t seed) {
  RandomNumbers random(seed);
  const LinearAllocation linear(vehicle);
  const int n = vehicle.num_rotors();
  std::vector<RandomRow> out;
  for (int k = 0; k < rows; ++k) {
    RandomRow row{Wrench::Zero(), Vector::Zero(n), Vector::Zero(n), Vector::Zero(n)};
    const Eigen::Quaterniond attitude = random.orientation();
    const Eigen::Vector3d force = random.in_ball(kMostForce), torque = random.in_ball(kMostTorque);
    row.wrench = joined(attitude.conjugate() * Eigen::Vector3d(0, 0, vehicle.mass * vehicle.gravity) + force, torque);
    linear.solve(row.wrench, Vector::Zero(n), row.throttle, row.angle);
    for (int i = 0; i < n; ++i) {
      if (vehicle.rotors[static_cast<std::size_t>(i)].tilt) row.previous[i] = row.angle[i] + random.uniform(-kMostStray, kMostStray);
    }
    out.push_back(std::move(row));
  }
  return out;
}

}  // namespace tenon
