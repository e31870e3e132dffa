// Forces of a scene, on any scalar type: generalised forces on both bodies, the power that no potential accounts for, and the potential.
#pragma once

#include <array>

#include "tenon/problems/contact/scene.hpp"

namespace tenon::contact {

template <class S, int D>
struct ForceValue {
  Velocities<S, D> Q_A = Velocities<S, D>::Zero(), Q_B = Velocities<S, D>::Zero();
  S power = S(0);      // W, of damping and of what is applied
  S potential = S(0);  // J
};

/// What a force expression may name: time, and the pose and motion of the body it acts on.
template <int D>
const std::vector<std::string>& force_variables() {
  static const std::vector<std::string> planar{"t", "x", "y", "theta", "vx", "vy", "omega"};
  static const std::vector<std::string> spatial{"t", "x", "y", "z", "vx", "vy", "vz"};
  return D == 2 ? planar : spatial;
}

template <class S, int D>
ForceValue<S, D> evaluate(const Force<D>& force, double t, const Positions<S, D>& q_a, const Velocities<S, D>& v_a,
                          const Positions<S, D>& q_b, const Velocities<S, D>& v_b) {
  using std::sqrt;
  ForceValue<S, D> out;
  const Pose<S, D> A(q_a, v_a), B(q_b, v_b);
  switch (force.kind) {
    case ForceKind::spring: {
      const Attached<S, D> a(A, force.at_a), b(B, force.at_b);
      const Point<S, D> d = a.x - b.x, ddot = a.xdot - b.xdot;
      Point<S, D> pull, damp;
      if (force.rest == 0) {  // an isotropic spring: no direction to lose at d = 0
        pull = S(force.stiffness) * d;
        damp = S(force.damping) * ddot;
        out.potential = S(0.5 * force.stiffness) * d.dot(d);
      } else {
        const S l = sqrt(d.dot(d)), stretch = l - S(force.rest);
        const Point<S, D> n = d / l;
        const S rate = n.dot(ddot);
        pull = S(force.stiffness * stretch) * n;
        damp = S(force.damping * rate) * n;
        out.potential = S(0.5 * force.stiffness) * stretch * stretch;
      }
      out.power = -damp.dot(ddot);
      const Point<S, D> on_b = pull + damp, on_a = -on_b;
      out.Q_A = A.force(a.r, on_a);
      out.Q_B = B.force(b.r, on_b);
      break;
    }
    case ForceKind::torsion:
      if constexpr (D == 2) {
        const S twist = q_a[2] - q_b[2] - S(force.rest), rate = v_a[2] - v_b[2];
        const S damp = S(force.damping) * rate, moment = S(force.stiffness) * twist + damp;
        out.Q_A = A.torque(S(-moment));
        out.Q_B = B.torque(moment);
        out.power = -damp * rate;
        out.potential = S(0.5 * force.stiffness) * twist * twist;
      }
      break;
    case ForceKind::applied:
    case ForceKind::expression: {
      const Attached<S, D> a(A, force.at_a);
      S scale(1);
      if (force.kind == ForceKind::expression) {
        std::array<S, 7> variables;
        variables[0] = S(t);
        for (int i = 0; i < 3; ++i)
          variables[static_cast<std::size_t>(1 + i)] = q_a[i], variables[static_cast<std::size_t>(4 + i)] = v_a[i];
        scale = force.expression.template evaluate<S>(variables);
      } else if (force.frequency != 0) {
        scale = S(std::sin(2 * std::numbers::pi * force.frequency * t + force.phase));
      }
      const Point<S, D> f = scale * force.force.template cast<S>();
      out.Q_A = A.force(a.r, f);
      out.power = f.dot(a.xdot);
      if constexpr (D == 2) {
        const S moment = scale * S(force.torque);
        out.Q_A += A.torque(moment);
        out.power += moment * v_a[2];
      }
      break;
    }
    case ForceKind::drag: {  // -damping v of the centre, -rest omega of the turn
      const Point<S, D> f = S(-force.damping) * A.pdot;
      Velocities<S, D> Q = A.force(Point<S, D>::Zero(), f);
      out.power = f.dot(A.pdot);
      for (int i = D; i < kVelocities<D>; ++i) {
        Q[i] -= S(force.rest) * v_a[i];
        out.power -= S(force.rest) * v_a[i] * v_a[i];
      }
      out.Q_A = Q;
      break;
    }
  }
  return out;
}

}  // namespace tenon::contact
