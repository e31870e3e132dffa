#include "tenon/problems/delta/wrist_dynamics.hpp"

namespace tenon::delta {

namespace {

/// T_i, row by row in world axes.
inline Matrix3 turning(int i, const Matrix3& p_inverse) {
  Matrix3 t;
  for (int k = 0; k < 3; ++k) t.row(k) = to_world(i, p_inverse.row(k));
  return t;
}

}  // namespace

Vector9 rates_of_wrist(const Robot& robot, const Configuration& at, const Vector3& velocity) {
  Vector9 v;
  for (int i = 0; i < kArms; ++i) v.segment<3>(3 * i).noalias() = at[i].jacobian(robot).inverse() * to_arm(i, velocity);
  return v;
}

Vector3 wrist_acceleration(const Robot& robot, const ArmConstants& k, const Configuration& at, const Vector3& velocity, const Vector3& u,
                           const Vector3& f) {
  Matrix3 inertia = Matrix3::Zero();
  Vector3 force = f;
  for (int i = 0; i < kArms; ++i) {
    const Matrix3 p_inverse = at[i].jacobian(robot).inverse(), t = turning(i, p_inverse);
    const ArmInertia m(k, at[i]);
    const Vector3 v = t * velocity;
    Vector3 torque = m * Vector3(p_inverse * at[i].bias(robot, v)) - coriolis(k, at[i], v) - k.damping.cwiseProduct(v) - gravity(k, at[i]);
    torque[0] += u[i];
    inertia.noalias() += t.transpose() * (m.matrix() * t);
    force.noalias() += t.transpose() * torque;
  }
  return inertia.llt().solve(force);
}

}  // namespace tenon::delta
