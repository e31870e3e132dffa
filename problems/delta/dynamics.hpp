// Forces on the delta robot, arm by arm and reduced to the motors.
//
//     m(q) v' + c(q, v) + damping v + g(q) = tau + (forces at the arm's tip)           3 x 3 for each arm            (delta.md, section 5)
//     M_y = Gamma' M Gamma,   tau_u = Gamma' G                                         seen by the motors            (section 6)
//
// Nothing here allocates or throws.
#pragma once

#include <array>

#include "tenon/problems/delta/kinematics.hpp"

namespace tenon::delta {

/// The robot's numbers as the equations of motion use them.
struct ArmConstants {
  double a, b, i, k;  // (5.1)
  double moment;      // lc1 M1 + l1 (M2 + M3), kg m
  double gravity;
  Vector3 damping;

  explicit ArmConstants(const Robot& robot)
      : a(robot.proximal_inertia + robot.proximal_com * robot.proximal_com * robot.proximal_mass +
          robot.proximal_length * robot.proximal_length * (robot.distal_mass + robot.tip_mass())),
        b(robot.proximal_length * (robot.distal_com * robot.distal_mass + robot.distal_length * robot.tip_mass())),
        i(robot.distal_inertia + robot.distal_com * robot.distal_com * robot.distal_mass +
          robot.distal_length * robot.distal_length * robot.tip_mass()),
        k(robot.distal_com * robot.distal_mass + robot.distal_length * robot.tip_mass()),
        moment(robot.proximal_com * robot.proximal_mass + robot.proximal_length * (robot.distal_mass + robot.tip_mass())),
        gravity(robot.gravity),
        damping(robot.damping) {}
};

/// m of one arm; its (2,3) entry is zero.
//
//     [ m11 m12 m13 ]
//     [ m12 m22  0  ]
//     [ m13  0  m33 ]
struct ArmInertia {
  double m11, m12, m13, m22, m33;

  ArmInertia(const ArmConstants& k, const ArmConfiguration& at)
      : m11(k.a),
        m12(k.b * (at.c1 * at.c2 * at.c3 + at.s1 * at.s2)),
        m13(-k.b * at.c1 * at.s2 * at.s3),
        m22(k.i),
        m33(k.i * at.s2 * at.s2) {}

  Vector3 operator*(const Vector3& v) const {
    return {m11 * v[0] + m12 * v[1] + m13 * v[2], m12 * v[0] + m22 * v[1], m13 * v[0] + m33 * v[2]};
  }
  /// m^-1 r; not finite where sin q2 = 0.
  Vector3 solve(const Vector3& r) const {
    const double f2 = m12 / m22, f3 = m13 / m33;
    const double x = (r[0] - f2 * r[1] - f3 * r[2]) / (m11 - f2 * m12 - f3 * m13);
    return {x, r[1] / m22 - f2 * x, r[2] / m33 - f3 * x};
  }
  Matrix3 matrix() const {
    Matrix3 m;
    m << m11, m12, m13, m12, m22, 0, m13, 0, m33;
    return m;
  }
};

/// c(q, v): Coriolis and centrifugal terms.
inline Vector3 coriolis(const ArmConstants& k, const ArmConfiguration& at, const Vector3& v) {
  const double v1 = v[0] * v[0], v2 = v[1] * v[1], v3 = v[2] * v[2], v23 = v[1] * v[2];
  return {k.b * ((at.s1 * at.c2 - at.c1 * at.s2 * at.c3) * v2 - at.c1 * at.s2 * at.c3 * v3 - 2 * at.c1 * at.c2 * at.s3 * v23),
          k.b * (at.c1 * at.s2 - at.s1 * at.c2 * at.c3) * v1 - k.i * at.s2 * at.c2 * v3,
          k.b * at.s1 * at.s2 * at.s3 * v1 + 2 * k.i * at.s2 * at.c2 * v23};
}

/// g(q): the gradient of the potential.
inline Vector3 gravity(const ArmConstants& k, const ArmConfiguration& at) {
  return k.gravity * Vector3(-k.moment * at.c1, -k.k * at.c2 * at.c3, k.k * at.s2 * at.s3);
}

double kinetic_energy(const ArmConstants& k, const Configuration& at, const Vector9& v);  // J
double potential_energy(const ArmConstants& k, const Configuration& at);                  // J, z down

/// tau_u: the motors' torque that holds the robot against gravity, N m. Infinite at type II.
Vector3 gravity_torque(const ArmConstants& k, const Configuration& at, const Motion& motion);

/// lambda of [B, H'] [tau_u; lambda] = G: the closure forces at rest, N.
Vector6 gravity_closure_forces(const Robot& robot, const Configuration& at, const Motion& motion);

enum class ReducedInertia {
  exact,           // Gamma' M Gamma
  projected_left,  // B' M Gamma: the published slides' form, which leaves out the inertial part of the closure forces
};

/// M_y, kg m^2.
Matrix3 reduced_inertia(const ArmConstants& k, const Configuration& at, const Motion& motion, ReducedInertia form = ReducedInertia::exact);

/// Gamma' r, for r the forces that belong to all nine angles.
inline Vector3 to_motors(const Motion& motion, const Vector9& r) {
  return motion.gamma[0].transpose() * r.head<3>() + motion.gamma[1].transpose() * r.segment<3>(3) +
         motion.gamma[2].transpose() * r.tail<3>();
}

// --- the index-1 form ------------------------------------------------------------------------------------------------------------------

struct Acceleration {
  Vector9 v_rate;  // rad/s^2
  Vector6 lambda;  // closure forces, N
};

/// [M, -H'; H, 0] [v'; lambda] = [B u + J_v' f - C - D - G; -Hdot v - alpha1 H v - alpha0 h],  alpha1 = 2p, alpha0 = p^2, p
/// `stabilisation`.
///
/// u: motor torques (N m), f: force on the wrist in world axes (N). Passes through type I and II; not finite where sin q_i2 = 0.
Acceleration acceleration(const Robot& robot, const ArmConstants& k, const Configuration& at, const Vector9& v, const Vector3& u,
                          const Vector3& f);

/// What one arm adds to the index-1 form, in its own frame.
struct ArmResidual {
  Vector3 balance;  // m v' + c + damping v + g - P' force, N m
  Vector3 tip;      // P v' + Pdot v + alpha1 P v + alpha0 psi, m/s^2: the same for all arms where the closure holds
};
ArmResidual arm_residual(const Robot& robot, const ArmConstants& k, const ArmConfiguration& at, const Vector3& v, const Vector3& v_rate,
                         const Vector3& force);

}  // namespace tenon::delta
