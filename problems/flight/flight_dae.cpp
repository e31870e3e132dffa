#include "tenon/problems/flight/flight_dae.hpp"

#include "tenon/problems/allocation/linear_allocation.hpp"

namespace tenon::flight {

namespace {

using Matrix3 = Eigen::Matrix3d;

Matrix3 cross_matrix(const Vector3d& v) {
  Matrix3 m;
  m << 0, -v[2], v[1], v[2], 0, -v[0], -v[1], v[0], 0;
  return m;
}

/// (1.2) of q = (w, v), a polynomial in q: R f = (w^2 - v.v) f + 2 (v.f) v + 2 w v x f
Vector3d rotated(double w, const Vector3d& v, const Vector3d& f) {
  return (w * w - v.squaredNorm()) * f + 2 * v.dot(f) * v + 2 * w * v.cross(f);
}

}  // namespace

FlightDae::FlightDae(Mission mission, MakeAllocator make_allocator)
    : mission_(std::move(mission)), make_allocator_(std::move(make_allocator)), rotors_(mission_.vehicle), at_{rotors_.size(), mission_.sensors.delay} {}

void FlightDae::initial_state(DaeState& state) const {
  const PoseReference start = mission_.reference.at(0);
  state.x.head<3>() = start.position;
  state.x[kAttitude] = start.attitude.w();
  state.x.segment<3>(kAttitude + 1) = start.attitude.vec();
  state.x.segment<3>(kVelocity) = start.velocity;
  state.x.segment<3>(kRate) = start.attitude.conjugate() * start.angular_velocity;
  // it hovers, as the controller takes it to be
  const RigidBody& body = mission_.controller.body;
  Wrench hover;
  hover << start.attitude.conjugate() * Vector3d(0, 0, body.mass * body.gravity), Vector3d::Zero();
  const int n = rotors_.size();
  Vector u(n), a(n);
  LinearAllocation(mission_.vehicle).solve(hover, Vector::Zero(n), u, a);
  for (int i = 0; i < n; ++i) {
    const Rotor& rotor = mission_.vehicle.rotors[static_cast<std::size_t>(i)];
    u[i] = std::clamp(u[i], rotor.throttle_lower, rotor.throttle_upper);
    a[i] = std::clamp(a[i], rotor.angle_lower, rotor.angle_upper);
  }
  state.x.tail(2 * n) << u, a;
  state.mode.discrete.assign(static_cast<std::size_t>(at_.discrete_size()), 0);
  Vector& held = state.mode.held;
  held = Vector::Zero(at_.held_size());
  held.head(at_.commands_size()) = state.x.tail(2 * n).replicate(1 + at_.delay, 1);
}

Vector3d FlightDae::wind(const DaeMode& mode) const { return mission_.wind.steady + mode.held.segment<3>(at_.gust()); }

void FlightDae::actuator_rates(const DaeMode& mode, ConstVectorRef x, VectorRef rates) const {
  const int n = rotors_.size();
  const Actuators& actuators = mission_.actuators;
  for (int i = 0; i < n; ++i) {
    const double limit = mission_.vehicle.rotors[static_cast<std::size_t>(i)].angle_rate_limit;
    const bool has_failed = mode.discrete[static_cast<std::size_t>(at_.failed(i))] != 0;
    const bool is_stuck = mode.discrete[static_cast<std::size_t>(at_.stuck(i))] != 0;
    const double wanted = (mode.held[n + i] - x[kRotors + n + i]) / actuators.servo_lag;
    rates[i] = ((has_failed ? 0 : mode.held[i]) - x[kRotors + i]) / actuators.rotor_lag;
    rates[n + i] = is_stuck ? 0 : std::clamp(wanted, -limit, limit);
  }
}

void FlightDae::derivatives(const DaeMode& mode, double, ConstVectorRef x, ConstVectorRef, Workspace&, VectorRef xdot, VectorRef y) const {
  const int n = rotors_.size();
  const Quaterniond q(x[kAttitude], x[kAttitude + 1], x[kAttitude + 2], x[kAttitude + 3]);
  const Vector3d w = x.segment<3>(kRate);
  y = rotors_.wrench(x.segment(kRotors, n), x.segment(kRotors + n, n));
  const RigidBody body{mission_.mass(), mission_.vehicle.inertia, mission_.vehicle.gravity};
  xdot.head<3>() = x.segment<3>(kVelocity);
  xdot[kAttitude] = -q.vec().dot(w) / 2;
  xdot.segment<3>(kAttitude + 1) = (q.w() * w + q.vec().cross(w)) / 2;
  xdot.segment<3>(kVelocity) = (rotated(q.w(), q.vec(), y.head<3>()) + wind(mode)) / body.mass - body.gravity * Vector3d::UnitZ();
  xdot.segment<3>(kRate) = body.angular_acceleration(y.tail<3>(), w);
  actuator_rates(mode, x, xdot.tail(2 * n));
}

void FlightDae::residual(const DaeMode& mode, const DaePoint& at, Workspace&, VectorRef F) const {
  const int n = rotors_.size(), nx = num_states();
  const double m = mission_.mass();
  const Vector3d v = at.x.segment<3>(kAttitude + 1), w = at.x.segment<3>(kRate), inertia = mission_.vehicle.inertia;
  const double q0 = at.x[kAttitude];
  F.head<3>() = at.xdot.head<3>() - at.x.segment<3>(kVelocity);
  F[kAttitude] = at.xdot[kAttitude] + v.dot(w) / 2;
  F.segment<3>(kAttitude + 1) = at.xdot.segment<3>(kAttitude + 1) - (q0 * w + v.cross(w)) / 2;
  F.segment<3>(kVelocity) = m * (at.xdot.segment<3>(kVelocity) + mission_.vehicle.gravity * Vector3d::UnitZ()) -
                            rotated(q0, v, at.y.head<3>()) - wind(mode);
  F.segment<3>(kRate) = inertia.cwiseProduct(at.xdot.segment<3>(kRate)) + w.cross(inertia.cwiseProduct(w)) - at.y.tail<3>();
  actuator_rates(mode, at.x, F.segment(kRotors, 2 * n));
  F.segment(kRotors, 2 * n) = at.xdot.tail(2 * n) - F.segment(kRotors, 2 * n);
  F.segment<6>(nx) = at.y - rotors_.wrench(at.x.segment(kRotors, n), at.x.segment(kRotors + n, n));
}

void FlightDae::jacobian(const DaeMode& mode, const DaePoint& at, double alpha, Workspace&, std::span<double> values) const {
  const int n = rotors_.size(), nx = num_states();
  const Vector3d v = at.x.segment<3>(kAttitude + 1), w = at.x.segment<3>(kRate), f = at.y.head<3>(), inertia = mission_.vehicle.inertia;
  const double q0 = at.x[kAttitude], m = mission_.mass();
  Eigen::Map<Eigen::MatrixXd> J(values.data(), nx + 6, nx + 6);
  J.setZero();
  J.diagonal().head(nx).setConstant(alpha);
  J.block<3, 3>(0, kVelocity) = -Matrix3::Identity();

  J.block<1, 3>(kAttitude, kAttitude + 1) = w.transpose() / 2;
  J.block<3, 1>(kAttitude + 1, kAttitude) = -w / 2;
  J.block<3, 3>(kAttitude + 1, kAttitude + 1) += cross_matrix(w) / 2;
  J.block<1, 3>(kAttitude, kRate) = v.transpose() / 2;
  J.block<3, 3>(kAttitude + 1, kRate) = -(q0 * Matrix3::Identity() + cross_matrix(v)) / 2;

  J.block<3, 3>(kVelocity, kVelocity) *= m;
  J.block<3, 1>(kVelocity, kAttitude) = -2 * (q0 * f + v.cross(f));
  J.block<3, 3>(kVelocity, kAttitude + 1) =
      -2 * (v.dot(f) * Matrix3::Identity() + v * f.transpose() - f * v.transpose() - q0 * cross_matrix(f));
  for (int k = 0; k < 3; ++k) J.block<3, 1>(kVelocity, nx + k) = -rotated(q0, v, Vector3d::Unit(k));

  J.block<3, 3>(kRate, kRate) = alpha * Matrix3(inertia.asDiagonal()) + cross_matrix(w) * inertia.asDiagonal() -
                                cross_matrix(inertia.cwiseProduct(w));
  J.block<3, 3>(kRate, nx + 3) = -Matrix3::Identity();

  for (int i = 0; i < n; ++i) {
    const double limit = mission_.vehicle.rotors[static_cast<std::size_t>(i)].angle_rate_limit;
    const double wanted = (mode.held[n + i] - at.x[kRotors + n + i]) / mission_.actuators.servo_lag;
    const bool follows = mode.discrete[static_cast<std::size_t>(at_.stuck(i))] == 0 && std::abs(wanted) < limit;
    J(kRotors + i, kRotors + i) += 1 / mission_.actuators.rotor_lag;
    if (follows) J(kRotors + n + i, kRotors + n + i) += 1 / mission_.actuators.servo_lag;
  }
  J.block<6, 6>(nx, nx).setIdentity();
  Eigen::MatrixXd by_u(6, n), by_a(6, n);
  rotors_.jacobian(at.x.segment(kRotors, n), at.x.segment(kRotors + n, n), by_u, by_a);
  J.block(nx, kRotors, 6, n) = -by_u;
  J.block(nx, kRotors + n, 6, n) = -by_a;
}

std::string FlightDae::state_name(int i) const {
  static const char* const names[] = {"x", "y", "z", "qw", "qx", "qy", "qz", "vx", "vy", "vz", "omegax", "omegay", "omegaz"};
  if (i < kRotors) return names[i];
  const int n = rotors_.size(), k = i - kRotors;
  return (k < n ? "u" : "a") + std::to_string(k % n + 1);
}

std::string FlightDae::algebraic_name(int i) const {
  static const char* const names[] = {"Fx", "Fy", "Fz", "Mx", "My", "Mz"};
  return names[i];
}

}  // namespace tenon::flight
