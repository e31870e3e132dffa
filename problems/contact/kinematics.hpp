// Where the points of a body are: position, velocity and the part of the acceleration that is there without vdot, on any scalar type, so
// that one text gives values and, on a scalar that carries derivatives, exact Jacobians.
//
//     planar   q = (x, y, theta)             v = (xdot, ydot, omega)
//     spatial  q = (x, y, z, qw, qx, qy, qz) v = (xdot, ydot, zdot, omega in body axes)         qdot = E(q) v
//
//     x_P = p + R s,    xdot_P = pdot + omega x R s,    bias = omega x (omega x R s)
#pragma once

#include "tenon/core/eigen.hpp"

namespace tenon::contact {

/// D = 2 planar, 3 spatial.
template <int D>
inline constexpr int kPositions = D == 2 ? 3 : 7;
template <int D>
inline constexpr int kVelocities = D == 2 ? 3 : 6;

template <class S, int D>
using Positions = Eigen::Matrix<S, kPositions<D>, 1>;
template <class S, int D>
using Velocities = Eigen::Matrix<S, kVelocities<D>, 1>;
template <class S, int D>
using Point = Eigen::Matrix<S, D, 1>;

/// omega x r in the plane, and in space.
template <class S>
Point<S, 2> cross(const S& omega, const Point<S, 2>& r) {
  return {-omega * r[1], omega * r[0]};
}
template <class S>
Point<S, 3> cross(const Point<S, 3>& a, const Point<S, 3>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// A body's pose and motion.
template <class S, int D>
struct Pose;

template <class S>
struct Pose<S, 2> {
  Point<S, 2> p, pdot;
  S omega;
  Eigen::Matrix<S, 2, 2> R;

  Pose(const Positions<S, 2>& q, const Velocities<S, 2>& v) : p(q.template head<2>()), pdot(v.template head<2>()), omega(v[2]) {
    using std::cos, std::sin;
    const S c = cos(q[2]), s = sin(q[2]);
    R << c, -s, s, c;
  }

  /// The generalised force of a force f at x_P = p + r, which is the gradient of f . x_P as well.
  Velocities<S, 2> force(const Point<S, 2>& r, const Point<S, 2>& f) const { return {f[0], f[1], r[0] * f[1] - r[1] * f[0]}; }
  Velocities<S, 2> torque(const S& moment) const { return {S(0), S(0), moment}; }
};

template <class S>
struct Pose<S, 3> {
  Point<S, 3> p, pdot, omega;  // omega in world axes
  Eigen::Matrix<S, 3, 3> R;

  /// The quaternion is normalised on the way, so that R stays a rotation where integration let |q| drift.
  Pose(const Positions<S, 3>& q, const Velocities<S, 3>& v) : p(q.template head<3>()), pdot(v.template head<3>()) {
    const S n = q[3] * q[3] + q[4] * q[4] + q[5] * q[5] + q[6] * q[6];
    const S w = q[3], x = q[4], y = q[5], z = q[6], k = S(2) / n;
    R << S(1) - k * (y * y + z * z), k * (x * y - w * z), k * (x * z + w * y),  //
        k * (x * y + w * z), S(1) - k * (x * x + z * z), k * (y * z - w * x),   //
        k * (x * z - w * y), k * (y * z + w * x), S(1) - k * (x * x + y * y);
    const Point<S, 3> body = v.template tail<3>();
    omega = R * body;
  }

  Velocities<S, 3> force(const Point<S, 3>& r, const Point<S, 3>& f) const {
    const Point<S, 3> moment = cross(r, f);
    return torque_of(f, moment);
  }
  Velocities<S, 3> torque(const Point<S, 3>& moment) const { return torque_of(Point<S, 3>(S(0), S(0), S(0)), moment); }

 private:
  Velocities<S, 3> torque_of(const Point<S, 3>& f, const Point<S, 3>& moment) const {
    Velocities<S, 3> Q;
    const Point<S, 3> in_body = R.transpose() * moment;
    Q << f, in_body;
    return Q;
  }
};

/// A point s of a body, or a vector that turns with it.
template <class S, int D>
struct Attached {
  Point<S, D> r, x, xdot, bias;

  Attached(const Pose<S, D>& pose, const Point<double, D>& s) {
    r = pose.R * s.template cast<S>();
    x = pose.p + r;
    const Point<S, D> turn = cross(pose.omega, r);
    xdot = pose.pdot + turn;
    bias = cross(pose.omega, turn);
  }
};

/// E(q) v.
template <class S>
Positions<S, 2> along(const Positions<S, 2>&, const Velocities<S, 2>& v) {
  return v;
}
template <class S>
Positions<S, 3> along(const Positions<S, 3>& q, const Velocities<S, 3>& v) {
  const S w = q[3], x = q[4], y = q[5], z = q[6], a = v[3], b = v[4], c = v[5];
  Positions<S, 3> rates;
  rates << v[0], v[1], v[2], 0.5 * (-x * a - y * b - z * c), 0.5 * (w * a + y * c - z * b), 0.5 * (w * b + z * a - x * c),
      0.5 * (w * c + x * b - y * a);
  return rates;
}

/// qdot = E(q) v. In space the quaternion's norm is drawn back to 1.
template <class S>
Positions<S, 2> position_rates(const Positions<S, 2>& q, const Velocities<S, 2>& v) {
  return along(q, v);
}
template <class S>
Positions<S, 3> position_rates(const Positions<S, 3>& q, const Velocities<S, 3>& v) {
  constexpr double kNormRate = 10;  // 1/s
  const S pull = kNormRate * (S(1) - q[3] * q[3] - q[4] * q[4] - q[5] * q[5] - q[6] * q[6]);
  Positions<S, 3> rates = along(q, v);
  for (int i = 3; i < 7; ++i) rates[i] += pull * q[i];
  return rates;
}

}  // namespace tenon::contact
