// What is looked at between the steps of ContactDae: guards, the closed-form flow, the step's bound, energy and the record's columns.
#include <algorithm>
#include <cmath>
#include <limits>

#include "tenon/problems/contact/contact_dae.hpp"
#include "tenon/problems/contact/features.hpp"

namespace tenon::contact {

/// h'' under the accelerations in xdot.
template <int D>
double ContactDae<D>::acceleration(const Constraint<D>& c, const GapValue<double, D>& g, ConstVectorRef xdot) const {
  double sum = g.bias;
  for (int l = 0; l < place(c.a).nv; ++l) sum += g.H_A[l] * xdot[place(c.a).v + l];
  for (int l = 0; l < place(c.b).nv; ++l) sum += g.H_B[l] * xdot[place(c.b).v + l];
  return sum;
}

template <int D>
void ContactDae<D>::guards(const DaeMode& mode, const DaePoint& at, Workspace& workspace, VectorRef values) const {
  auto& bodies = static_cast<Bodies&>(*workspace);
  load(mode, at.t, at.x, bodies);
  values.setOnes();
  for (const int i : contacts_) {
    const Constraint<D>& c = scene_.constraints[static_cast<std::size_t>(i)];
    const int m = mode.discrete[static_cast<std::size_t>(i)];
    if (m == kContact) {
      values[2 * i] = at.y[i];
      const int feature = bodies.features[static_cast<std::size_t>(i)];
      int next;  // is the transition's business; a nanometre late, so that a start on the border is awake
      if (feature != kNearest)
        values[2 * i + 1] = inside_feature(c, feature, seen_from(c, of(bodies.poses, c.a), of(bodies.poses, c.b)), next) + kTouching;
      continue;
    }
    const GapValue<double, D> g = gap_of(i, at.t, bodies);
    const double hddot = c.law.acceleration(g.h, g.hdot);
    if (m == kFree) {
      // falls through 0 where the gap is closed and closing; a contact just released sleeps until one of both is over
      values[2 * i] = std::max(g.h + kGapTolerance, g.hdot + 2 * kSpeedTolerance);
      // a point that has gone round a corner inside the shape opens again, toward another face: it has come in all the same
      if (c.is_two_scale) values[2 * i + 1] = g.h + kTouching;
      if (!c.is_two_scale && g.h <= 0 && g.hdot < -2 * kSpeedTolerance) {  // closing, but the law would pull: until it would not
        values[2 * i + 1] = acceleration(c, g, at.xdot) - hddot;
      }
    }
    if (m == kCollision) {
      // falls through 0 where |h'| and |h''| are both small
      values[2 * i] = at.y[i];
      values[2 * i + 1] = std::pow(g.hdot / c.rest_speed, 2) + std::pow(hddot / c.rest_acceleration, 2) - 1;
    }
  }
}

/// Gravity alone between contacts, and no spatial body whose rotation is not uniform.
template <int D>
bool ContactDae<D>::has_exact_flow(const DaeMode& mode) const {
  return is_ballistic_ && std::all_of(mode.discrete.begin(), mode.discrete.end(), [](int m) { return m == kFree; });
}

template <int D>
void ContactDae<D>::exact_flow(const DaeMode&, double dt, ConstVectorRef x, VectorRef next) const {
  next = x;
  for (const Place at : places_) {
    next.segment(at.q, at.nv) += dt * x.segment(at.v, at.nv);
    for (int l = 0; l < std::min(D, at.nv); ++l) {
      next[at.q + l] += 0.5 * dt * dt * scene_.gravity[l];
      next[at.v + l] += dt * scene_.gravity[l];
    }
  }
}

template <int D>
bool ContactDae<D>::guards_read_derivatives(const DaeMode& mode) const {
  return has_one_law_ ||
         std::any_of(contacts_.begin(), contacts_.end(), [&](int i) { return mode.discrete[static_cast<std::size_t>(i)] != kFree; });
}

/// As long as it takes to come from the gap to the contact's reach beyond it at this speed and under gravity, in whatever direction: no gap
/// closes faster than its points move, so that nobody passes through a shape between two samples of a step. And half a radian of a turning
/// body above a face, which has nothing behind it.
template <int D>
double ContactDae<D>::max_step(const DaeState& state, Workspace& workspace) const {
  auto& bodies = static_cast<Bodies&>(*workspace);
  load(state.mode, state.t, state.x, bodies);
  const double gravity = scene_.gravity.norm();
  double longest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    const int i = contacts_[k];
    const Constraint<D>& c = scene_.constraints[static_cast<std::size_t>(i)];
    if (state.mode.discrete[static_cast<std::size_t>(i)] != kFree) continue;
    const Pose<double, D>&A = of(bodies.poses, c.a), &B = of(bodies.poses, c.b);
    if (c.shape.is_face()) {
      if (c.gap.a.squaredNorm() > 0 && place(c.a).nv > D)
        longest = std::min(longest, 0.5 / of(bodies.v, c.a).tail(kVelocities<D> - D).norm());
      continue;
    }
    const GapValue<double, D> g = gap_of(i, state.t, bodies);
    const Point<double, D> turn_a = cross(A.omega, g.at_a), turn_b = cross(B.omega, g.at_b);
    const double way = std::max(g.h, 0.0) + reach_[k], speed = (A.pdot + turn_a - B.pdot - turn_b).norm();
    longest = std::min(longest, 2 * way / (speed + std::sqrt(speed * speed + 2 * gravity * way)));
  }
  return longest;
}

template <int D>
double ContactDae<D>::energy_of(double t, const Bodies& bodies) const {
  double sum = 0;
  for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
    for (int l = 0; l < places_[i].nv; ++l) sum += 0.5 * bodies.v[i][l] * bodies.v[i][l] / inverse_mass(static_cast<int>(i), l);
    for (int l = 0; l < std::min(D, places_[i].nq); ++l) sum -= scene_.bodies[i].mass * scene_.gravity[l] * bodies.q[i][l];
  }
  for (const Force<D>& force : scene_.forces) {
    if (force.kind != ForceKind::spring && force.kind != ForceKind::torsion) continue;
    sum +=
        evaluate<double, D>(force, t, of(bodies.q, force.a), of(bodies.v, force.a), of(bodies.q, force.b), of(bodies.v, force.b)).potential;
  }
  return sum;
}

template <int D>
double ContactDae<D>::energy(double t, ConstVectorRef x, Workspace& workspace) const {
  auto& bodies = static_cast<Bodies&>(*workspace);
  load(t, x, bodies);
  return energy_of(t, bodies);
}

template <int D>
Point<double, D> ContactDae<D>::momentum(ConstVectorRef x) const {
  Point<double, D> sum = Point<double, D>::Zero();
  for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
    for (int l = 0; l < std::min(D, places_[i].nv); ++l) sum[l] += scene_.bodies[i].mass * x[places_[i].v + l];
  }
  return sum;
}

template <int D>
std::string ContactDae<D>::algebraic_name(int i) const {
  const int k = i - num_constraints();
  const int constraint = k < 0 ? i : index_2_[static_cast<std::size_t>(k)];
  return (k < 0 ? "lambda_" : "mu_") + scene_.constraints[static_cast<std::size_t>(constraint)].name;
}

template <int D>
std::string ContactDae<D>::output_name(int i) const {
  const int n = static_cast<int>(contacts_.size());
  if (i == 2 * n) return "energy";
  if (i == 2 * n + 1) return "energy_error";
  return (i < n ? "gap_" : "mode_") + scene_.constraints[static_cast<std::size_t>(contacts_[static_cast<std::size_t>(i % n)])].name;
}

template <int D>
void ContactDae<D>::outputs(const DaeState& state, Workspace& workspace, VectorRef values) const {
  auto& bodies = static_cast<Bodies&>(*workspace);
  load(state.mode, state.t, state.x, bodies);
  const int n = static_cast<int>(contacts_.size());
  for (int k = 0; k < n; ++k) {
    const int i = contacts_[static_cast<std::size_t>(k)];
    values[k] = gap_of(i, state.t, bodies).h;
    values[n + k] = state.mode.discrete[static_cast<std::size_t>(i)];
  }
  values[2 * n] = energy_of(state.t, bodies);
  if (scene_.with_audit) values[2 * n + 1] = values[2 * n] - state.mode.held[kHeldEnergy] - state.x.tail(num_states_ - works_).sum();
}

template class ContactDae<2>;
template class ContactDae<3>;

}  // namespace tenon::contact
