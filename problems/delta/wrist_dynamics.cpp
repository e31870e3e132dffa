#include "tenon/problems/delta/wrist_dynamics.hpp"

namespace tenon::delta {

namespace {

/// P^-1, row by row, from d'(V - l1 e1 q1') = 0 and what of V is along d2 and d3.
inline Matrix3 turning(const Robot& robot, const ArmConfiguration& arm) {
  const Vector3 d = arm.d(), d2 = arm.d2(), d3 = arm.d3(), elbow = robot.proximal_length * arm.e1();
  Matrix3 rows;  // as columns
  rows.col(0) = d / d.dot(elbow);
  rows.col(1) = (d2 - d2.dot(elbow) * rows.col(0)) / robot.distal_length;
  rows.col(2) = (d3 - d3.dot(elbow) * rows.col(0)) / (robot.distal_length * arm.s2);
  return rows.transpose();
}

}  // namespace

Vector9 rates_of_wrist(const Robot& robot, const Configuration& at, const Vector3& velocity) {
  Vector9 v;
  for (int i = 0; i < kArms; ++i) v.segment<3>(3 * i).noalias() = turning(robot, at[i]) * to_arm(i, velocity);
  return v;
}

WristBalance wrist_balance(const Robot& robot, const ArmConstants& k, const Configuration& at, const Vector3& velocity, const Vector3& u,
                           const Vector3& f) {
  WristBalance out{.force = f};
  for (int i = 0; i < kArms; ++i) {
    const Matrix3 p_inverse = turning(robot, at[i]);
    Matrix3 t;
    for (int r = 0; r < 3; ++r) t.row(r) = to_world(i, p_inverse.row(r));
    const ArmInertia m(k, at[i]);
    const Vector3 v = t * velocity;
    Vector3 torque = m * Vector3(p_inverse * at[i].bias(robot, v)) - coriolis(k, at[i], v) - k.damping.cwiseProduct(v) - gravity(k, at[i]);
    torque[0] += u[i];
    for (int c = 0; c < 3; ++c) out.inertia.col(c).noalias() += t.transpose() * (m * Vector3(t.col(c)));
    out.force.noalias() += t.transpose() * torque;
  }
  return out;
}

Vector3 wrist_acceleration(const Robot& robot, const ArmConstants& k, const Configuration& at, const Vector3& velocity, const Vector3& u,
                           const Vector3& f) {
  const WristBalance balance = wrist_balance(robot, k, at, velocity, u, f);
  return balance.inertia.llt().solve(balance.force);
}

}  // namespace tenon::delta
