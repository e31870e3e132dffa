#include "tenon/problems/envelope/envelope.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "tenon/problems/allocation/linear_allocation.hpp"

namespace tenon {

namespace {

constexpr double kConvex = 1e-4;    // deviation up to which the true maps correct the convex answer
constexpr double kHover = 1 - 1e-9;  // of the weight: rounding
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

std::vector<Rotor> working(const Vehicle& vehicle, int failed) {
  std::vector<Rotor> rotors = vehicle.rotors;
  if (failed >= 0) rotors.erase(rotors.begin() + failed);
  return rotors;
}

std::vector<std::string> lost_directions(const Vehicle& vehicle, int failed) {
  LinearAllocation linear(vehicle);
  if (failed >= 0) linear.fail_rotor(failed);
  return linear.unreachable_directions();
}

Wrench force(const Eigen::Vector3d& f) {
  Wrench w;
  w << f, Eigen::Vector3d::Zero();
  return w;
}

Wrench torque(const Eigen::Vector3d& m) {
  Wrench w;
  w << Eigen::Vector3d::Zero(), m;
  return w;
}

/// Where a solve from x ends, nothing where it fails.
std::optional<Vector> solve(Solver& solver, const Vector& x) {
  Point point(static_cast<int>(x.size()), 6);
  point.x = x;
  return succeeded(solver.solve(point).status) ? std::optional(point.x) : std::nullopt;
}

}  // namespace

Envelope::Envelope(const Vehicle& vehicle, int failed, const SolverFactory& make_solver)
    : num_rotors_(vehicle.num_rotors()),
      weight_(vehicle.mass * vehicle.gravity),
      rotors_(working(vehicle, failed)),
      set_(rotors_),
      is_convex_(set_.deviation() <= kConvex),
      unreachable_(lost_directions(vehicle, failed)),
      farthest_(rotors_, RayProgram::Aim::farthest),
      least_effort_(rotors_, RayProgram::Aim::least_effort) {
  if (!is_convex_ && make_solver) {
    farthest_solver_ = make_solver(farthest_);
    least_effort_solver_ = make_solver(least_effort_);
  }
  hovers_level_ = farthest(Wrench::Zero(), force(Eigen::Vector3d::UnitZ())).length >= kHover * weight_;
}

EnvelopePoint Envelope::at(const Eigen::Vector3d& direction) {
  const Farthest most_force = farthest(Wrench::Zero(), force(direction)), most_torque = farthest(Wrench::Zero(), torque(direction));
  EnvelopePoint point{kNone, kNone, most_force.length, most_torque.length, kNone, most_force.gap, most_torque.gap};
  if (hovers_level_) {
    const Farthest at_hover = farthest(weight_ * force(Eigen::Vector3d::UnitZ()), torque(direction));
    point.torque_hover = at_hover.length;
    point.torque_gap = std::max(point.torque_gap, at_hover.gap);
  }
  if (weight_ > 0 && most_force.length >= kHover * weight_) {
    const Vector thrust = thrusts(weight_ * force(direction));
    point.X1 = weight_ / thrust.sum();
    point.X2 = weight_ / (num_rotors_ * thrust.maxCoeff());
  }
  return point;
}

Envelope::Farthest Envelope::farthest(const Wrench& from, const Wrench& direction) {
  const AttainableSet::Answer answer = set_.farthest(from, direction);
  double length = std::max(0.0, answer.length);
  if (answer.normal.isZero()) return {length, 0};
  // t <= (support(n) - n'W) / n'd
  const double bound = (set_.support(answer.normal) - answer.normal.dot(from)) / answer.normal.dot(direction);
  if (farthest_solver_) {
    farthest_.set_ray(from, direction);
    length = kNone;
    for (const Vector& x : {start(answer), start(set_.least_effort(from + 0.5 * answer.length * direction)), neutral()}) {
      const std::optional<Vector> found = solve(*farthest_solver_, x);
      if (found && !(found->tail<1>()[0] < std::max(0.0, length))) length = found->tail<1>()[0];
    }
    if (std::isnan(length)) {
      ++failures_;
      return {kNone, 0};
    }
  }
  return {length, std::max(0.0, bound - length)};
}

/// Of the least effort at a wrench, for each working rotor.
Vector Envelope::thrusts(const Wrench& wrench) {
  Vector x = start(set_.least_effort(wrench));
  if (least_effort_solver_) {
    least_effort_.set_ray(wrench);
    const std::optional<Vector> found = solve(*least_effort_solver_, x);
    if (!found) ++failures_;
    x = found ? *found : Vector::Constant(x.size(), kNone);
  }
  Vector thrust(std::ssize(rotors_));
  for (std::size_t i = 0; i < rotors_.size(); ++i) {
    thrust[static_cast<Eigen::Index>(i)] = set_.rotors()[i].thrust(x[static_cast<Eigen::Index>(i)]);
  }
  return thrust;
}

Vector Envelope::start(const AttainableSet::Answer& answer) const {
  const Eigen::Index n = std::ssize(rotors_);
  Vector x(2 * n + 1);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const RotorReach::Command command = set_.rotors()[k].command(answer.y[k]);
    x[i] = command.throttle;
    x[n + i] = command.angle;
  }
  x[2 * n] = answer.length;
  return x;
}

/// Every throttle and angle in the middle of its limits.
Vector Envelope::neutral() const {
  const Eigen::Index n = std::ssize(rotors_);
  Vector x = Vector::Zero(2 * n + 1);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Rotor& rotor = rotors_[static_cast<std::size_t>(i)];
    x[i] = (rotor.throttle_lower + rotor.throttle_upper) / 2;
    if (std::isfinite(rotor.angle_lower) && std::isfinite(rotor.angle_upper)) x[n + i] = (rotor.angle_lower + rotor.angle_upper) / 2;
  }
  return x;
}

}  // namespace tenon
