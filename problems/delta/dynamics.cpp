#include "tenon/problems/delta/dynamics.hpp"

namespace tenon::delta {

double kinetic_energy(const ArmConstants& k, const Configuration& at, const Vector9& v) {
  double energy = 0;
  for (int i = 0; i < kArms; ++i) {
    const Vector3 rate = v.segment<3>(3 * i);
    energy += rate.dot(ArmInertia(k, at[i]) * rate) / 2;
  }
  return energy;
}

double potential_energy(const ArmConstants& k, const Configuration& at) {
  double energy = 0;
  for (const ArmConfiguration& arm : at.arm) energy -= k.gravity * (k.moment * arm.s1 + k.k * arm.s2 * arm.c3);
  return energy;
}

Vector3 gravity_torque(const ArmConstants& k, const Configuration& at, const Motion& motion) {
  Vector3 torque = Vector3::Zero();
  for (int i = 0; i < kArms; ++i) torque.noalias() += motion.gamma[std::size_t(i)].transpose() * gravity(k, at[i]);
  return torque;
}

Vector6 gravity_closure_forces(const Robot& robot, const Configuration& at, const Motion& motion) {
  // F_i, the force of the closure on tip i: across the link what its weight asks for; along it what makes F_1 + F_2 + F_3 = 0     (6.3)
  const ArmConstants k(robot);
  std::array<Vector3, kArms> force;
  Vector3 sum = Vector3::Zero();
  for (int i = 0; i < kArms; ++i) {
    const Vector3 g = gravity(k, at[i]);
    force[std::size_t(i)] = to_world(i, (g[1] * at[i].d2() + g[2] / at[i].s2 * at[i].d3()) / robot.distal_length);
    sum += force[std::size_t(i)];
  }
  const Vector3 along = -(motion.a_inverse.transpose() * sum);
  Vector6 lambda;
  for (int i = 1; i < kArms; ++i) lambda.segment<3>(3 * (i - 1)) = -(force[std::size_t(i)] + along[i] * motion.a.row(i).transpose());
  return lambda;
}

Matrix3 reduced_inertia(const ArmConstants& k, const Configuration& at, const Motion& motion, ReducedInertia form) {
  Matrix3 inertia = Matrix3::Zero();
  for (int i = 0; i < kArms; ++i) {
    const ArmInertia m(k, at[i]);
    const Matrix3& g = motion.gamma[std::size_t(i)];
    const Vector3 g2 = g.row(1), g3 = g.row(2);
    // row i of Gamma_i is the unit vector e_i, so that  Gamma_i' m Gamma_i = e_i (m11/2 e_i + m12 g2 + m13 g3)' + transpose + m22 g2 g2' +
    // m33 g3 g3'
    const Vector3 row = m.m12 * g2 + m.m13 * g3;
    inertia.row(i) += row.transpose();
    inertia(i, i) += m.m11;
    if (form == ReducedInertia::projected_left) continue;
    inertia.col(i) += row;
    inertia.noalias() += (m.m22 * g2) * g2.transpose() + (m.m33 * g3) * g3.transpose();
  }
  return inertia;
}

namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// S x = r by S = L D L', from S's lower triangle, which L and D replace; x replaces r. Written out, so that the compiler unrolls it.
inline void solve_positive_definite(Matrix6& s, Vector6& x) {
  constexpr int n = 6;
  Vector6 inverse_d;
  for (int j = 0; j < n; ++j) {
    inverse_d[j] = 1 / s(j, j);
    for (int i = j + 1; i < n; ++i) {
      const double l = s(i, j) * inverse_d[j];
      for (int k = i; k < n; ++k) s(k, i) -= l * s(k, j);
    }
    for (int i = j + 1; i < n; ++i) s(i, j) *= inverse_d[j];
  }
  for (int j = 0; j < n; ++j) {
    for (int i = j + 1; i < n; ++i) x[i] -= s(i, j) * x[j];
  }
  x = x.cwiseProduct(inverse_d);
  for (int j = n - 1; j >= 0; --j) {
    for (int i = j + 1; i < n; ++i) x[j] -= s(i, j) * x[i];
  }
}

}  // namespace

Acceleration acceleration(const Robot& robot, const ArmConstants& k, const Configuration& at, const Vector9& v, const Vector3& u,
                          const Vector3& f) {
  // tip forces F_1 = lambda_1 + lambda_2, F_2 = -lambda_1, F_3 = -lambda_2 move the tips by  a_i + W_i F_i,  W_i = R_i P m^-1 P' R_i' (5.6)
  const double alpha1 = 2 * robot.stabilisation, alpha0 = robot.stabilisation * robot.stabilisation;
  std::array<Matrix3, kArms> p, w;
  std::array<Vector3, kArms> free, tip;  // angles' acceleration without closure; the tip's, with what stabilises it
  for (int i = 0; i < kArms; ++i) {
    const std::size_t n = std::size_t(i);
    const ArmConfiguration& arm = at[i];
    const ArmInertia m(k, arm);
    const Vector3 rate = v.segment<3>(3 * i);
    const Matrix3 local = arm.jacobian(robot);
    for (int c = 0; c < 3; ++c) p[n].col(c) = to_world(i, local.col(c));
    Vector3 force = p[n].transpose() * f / 3 - coriolis(k, arm, rate) - gravity(k, arm) - k.damping.cwiseProduct(rate);
    force[0] += u[i];
    free[n] = m.solve(force);
    tip[n] = p[n] * (free[n] + alpha1 * rate) + to_world(i, arm.bias(robot, rate) + alpha0 * arm.wrist(robot));
    Matrix3 mobility;  // m^-1 P'
    for (int c = 0; c < 3; ++c) mobility.col(c) = m.solve(p[n].row(c));
    w[n].noalias() = p[n] * mobility;
  }
  // [ W1 + W2    W1    ] [ lambda_1 ]     [ tip_1 - tip_2 ]
  // [   W1     W1 + W3 ] [ lambda_2 ] = - [ tip_1 - tip_3 ]
  Matrix6 s;
  s.topLeftCorner<3, 3>() = w[0] + w[1];
  s.bottomLeftCorner<3, 3>() = w[0];
  s.bottomRightCorner<3, 3>() = w[0] + w[2];
  Acceleration out;
  out.lambda.head<3>() = tip[1] - tip[0];
  out.lambda.tail<3>() = tip[2] - tip[0];
  solve_positive_definite(s, out.lambda);
  const Vector3 l1 = out.lambda.head<3>(), l2 = out.lambda.tail<3>();
  const std::array<Vector3, kArms> closing{l1 + l2, -l1, -l2};
  for (int i = 0; i < kArms; ++i) {
    const std::size_t n = std::size_t(i);
    out.v_rate.segment<3>(3 * i) = free[n] + ArmInertia(k, at[i]).solve(p[n].transpose() * closing[n]);
  }
  return out;
}

ArmResidual arm_residual(const Robot& robot, const ArmConstants& k, const ArmConfiguration& at, const Vector3& v, const Vector3& v_rate,
                         const Vector3& force) {
  const double alpha1 = 2 * robot.stabilisation, alpha0 = robot.stabilisation * robot.stabilisation;
  const Matrix3 p = at.jacobian(robot);
  return {ArmInertia(k, at) * v_rate + coriolis(k, at, v) + k.damping.cwiseProduct(v) + gravity(k, at) - p.transpose() * force,
          p * (v_rate + alpha1 * v) + at.bias(robot, v) + alpha0 * at.wrist(robot)};
}

}  // namespace tenon::delta
