// Gap functions, each with its exact gradient H and the part of h'' that is there without vdot (Hdot v).
//
//     point and point   h = sign (|x_A - x_B| - offset)
//     point and face    h = n . (x_A - x_B) - offset          n turns with body B
//     coordinate        h = axis . (x_A - x_B) - offset       axis fixed in the world: joints
//     angle             h = theta_A - theta_B - offset        planar
//
// A time-dependent offset, offset + amplitude sin(2 pi f t + phase), drives a joint. Derivation: contact.md, equations (4) to (9).
#pragma once

#include <numbers>

#include "tenon/problems/contact/kinematics.hpp"

namespace tenon::contact {

enum class GapKind { point_point, point_face, point_edge, coordinate, angle };

/// One smooth gap between two bodies; which features of their shapes it joins was decided before.
template <int D>
struct Gap {
  GapKind kind = GapKind::point_face;
  Point<double, D> a = Point<double, D>::Zero();  // in body A's axes
  Point<double, D> b = Point<double, D>::Zero();  // in body B's
  Point<double, D> n = Point<double, D>::Zero();  // point_face: in body B's axes; point_edge: along the edge; coordinate: in the world's
  double offset = 0, sign = 1;
  double amplitude = 0, frequency = 0, phase = 0;  // of the drive: Hz, rad
};

template <class S, int D>
struct GapValue {
  S h, hdot, bias;                 // h'' = H vdot + bias
  S rate;                          // H v: hdot less what the drive adds
  Velocities<S, D> H_A, H_B;       // gradients
  Point<S, D> normal, at_a, at_b;  // unit, from B to A; arms from either body's centre to the place of contact
};

template <class S, int D>
GapValue<S, D> evaluate(const Gap<D>& gap, double t, const Pose<S, D>& A, const Pose<S, D>& B) {
  using std::sqrt;
  GapValue<S, D> out;
  if (gap.kind == GapKind::angle) {
    if constexpr (D == 2) {
      out.rate = A.omega - B.omega;
      out.bias = S(0);
      out.H_A = A.torque(S(1));
      out.H_B = B.torque(S(-1));
      out.normal.setZero(), out.at_a.setZero(), out.at_b.setZero();
    }
    out.h = S(0);  // set by the caller, who has the angles
  } else {
    const Attached<S, D> a(A, gap.a), b(B, gap.b);
    const Point<S, D> d = a.x - b.x, ddot = a.xdot - b.xdot, dbias = a.bias - b.bias;
    out.at_a = a.r;
    out.at_b = a.x - B.p;
    if (gap.kind == GapKind::point_point) {
      const S l = sqrt(d.dot(d));
      const Point<S, D> n = d / l;
      const S ldot = n.dot(ddot);
      out.h = gap.sign * (l - gap.offset);
      out.rate = gap.sign * ldot;
      out.bias = gap.sign * (n.dot(dbias) + (ddot.dot(ddot) - ldot * ldot) / l);
      out.normal = gap.sign * n;
      out.at_b = b.r;
    } else if (gap.kind == GapKind::point_edge) {
      // the distance to the line through b along n:  e = (I - uu') d
      const Point<S, D> u = B.R * gap.n.template cast<S>(), udot = cross(B.omega, u), ubias = cross(B.omega, udot);
      const S s = u.dot(d), sdot = udot.dot(d) + u.dot(ddot), sbias = ubias.dot(d) + S(2) * udot.dot(ddot) + u.dot(dbias);
      const Point<S, D> e = d - s * u, edot = ddot - sdot * u - s * udot, ebias = dbias - sbias * u - S(2) * sdot * udot - s * ubias;
      const S l = sqrt(e.dot(e));
      const Point<S, D> n = e / l;
      const S ldot = n.dot(edot);
      out.h = l - gap.offset;
      out.rate = ldot;
      out.bias = n.dot(ebias) + (edot.dot(edot) - ldot * ldot) / l;
      out.normal = n;
    } else if (gap.kind == GapKind::point_face) {
      const Point<S, D> n = B.R * gap.n.template cast<S>(), ndot = cross(B.omega, n), nbias = cross(B.omega, ndot);
      out.h = n.dot(d) - gap.offset;
      out.rate = n.dot(ddot) + ndot.dot(d);
      out.bias = n.dot(dbias) + S(2) * ndot.dot(ddot) + nbias.dot(d);
      out.normal = n;
    } else {
      const Point<S, D> n = gap.n.template cast<S>();
      out.h = n.dot(d) - gap.offset;
      out.rate = n.dot(ddot);
      out.bias = n.dot(dbias);
      out.normal = n;
      out.at_b = b.r;
    }
    out.H_A = A.force(out.at_a, out.normal);
    const Point<S, D> opposite = -out.normal;
    out.H_B = B.force(out.at_b, opposite);
  }
  out.hdot = out.rate;
  if (gap.amplitude != 0) {
    const double w = 2 * std::numbers::pi * gap.frequency, angle = w * t + gap.phase;
    out.h -= gap.amplitude * std::sin(angle);
    out.hdot -= gap.amplitude * w * std::cos(angle);
    out.bias += gap.amplitude * w * w * std::sin(angle);
  }
  return out;
}

}  // namespace tenon::contact
