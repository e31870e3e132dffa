// What one active constraint brings to the equations, on any scalar type.
//
//     law row   H vdot + Hdot v + alpha1 h' + alpha0 h + alpha3 h^3         without H vdot
//     forces    lambda (H' + friction) on either body
//
// Regularised Coulomb friction at the place of contact:  f = -mu lambda tanh(|v_t| / v_s) v_t / |v_t|.   (10)
#pragma once

#include "tenon/problems/contact/scene.hpp"

namespace tenon::contact {

/// The gap itself, angles included, which poses alone do not tell.
template <class S, int D>
GapValue<S, D> evaluate_gap(const Gap<D>& gap, double t, const Pose<S, D>& A, const Pose<S, D>& B, const Positions<S, D>& q_a,
                            const Positions<S, D>& q_b) {
  GapValue<S, D> g = evaluate<S, D>(gap, t, A, B);
  if (gap.kind == GapKind::angle) g.h += q_a[2] - q_b[2] - S(gap.offset);
  return g;
}

/// Generalised forces of one unit of lambda, and their power.
template <class S, int D>
void push_of(const Constraint<D>& c, const GapValue<S, D>& g, const Pose<S, D>& A, const Pose<S, D>& B, Velocities<S, D>& on_a,
             Velocities<S, D>& on_b, S& power) {
  using std::sqrt, std::tanh;
  on_a = g.H_A;
  on_b = g.H_B;
  power = g.rate;
  if (c.friction == 0) return;
  const Point<S, D> back = S(c.radius_a) * g.normal, arm_a = g.at_a - back, arm_b = g.at_b - back;
  const Point<S, D> turn_a = cross(A.omega, arm_a), turn_b = cross(B.omega, arm_b);
  const Point<S, D> slip = A.pdot + turn_a - B.pdot - turn_b;
  const S through = g.normal.dot(slip);
  const Point<S, D> v_t = slip - through * g.normal;
  const S speed = sqrt(S(v_t.dot(v_t) + S(1e-24)));
  const S factor = S(-c.friction) * tanh(S(speed / c.friction_speed)) / speed;
  const Point<S, D> f = factor * v_t, opposite = -f;
  on_a += A.force(arm_a, f);
  on_b += B.force(arm_b, opposite);
  power += f.dot(v_t);
}

template <class S, int D>
struct ConstraintRows {
  S h, hdot, law, power;
  Velocities<S, D> H_A, H_B, on_a, on_b;
};

template <class S, int D>
ConstraintRows<S, D> constraint_rows(const Constraint<D>& c, const Gap<D>& gap, double t, const Pose<S, D>& A, const Pose<S, D>& B,
                                     const Positions<S, D>& q_a, const Positions<S, D>& q_b, double lambda) {
  const GapValue<S, D> g = evaluate_gap<S, D>(gap, t, A, B, q_a, q_b);
  ConstraintRows<S, D> out;
  push_of<S, D>(c, g, A, B, out.on_a, out.on_b, out.power);
  out.h = g.h;
  out.hdot = g.hdot;
  out.law = g.bias + S(c.law.alpha1) * g.hdot + S(c.law.alpha0) * g.h + S(c.law.alpha3) * g.h * g.h * g.h;
  out.H_A = g.H_A;
  out.H_B = g.H_B;
  out.on_a *= S(lambda);
  out.on_b *= S(lambda);
  out.power *= S(lambda);
  return out;
}

}  // namespace tenon::contact
