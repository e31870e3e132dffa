// The Jacobian of ContactDae: each constraint and force is evaluated once on numbers that carry their derivatives with respect to the
// positions and velocities of its two bodies, so that it is exact, and no formula stands twice.
#include "tenon/problems/contact/constraint_rows.hpp"
#include "tenon/problems/contact/contact_dae.hpp"
#include "tenon/problems/contact/dual.hpp"
#include "tenon/problems/contact/features.hpp"

namespace tenon::contact {

namespace {

/// Positions and velocities of both bodies.
template <int D>
inline constexpr int kLocal = 2 * (kPositions<D> + kVelocities<D>);
template <int D>
using LocalDual = Dual<kLocal<D>>;

template <int D>
struct LocalState {
  Positions<LocalDual<D>, D> q_a, q_b;
  Velocities<LocalDual<D>, D> v_a, v_b;

  LocalState(const Positions<double, D>& qa, const Velocities<double, D>& va, const Positions<double, D>& qb,
             const Velocities<double, D>& vb) {
    int k = 0;
    for (int l = 0; l < kPositions<D>; ++l) q_a[l] = LocalDual<D>(qa[l], kLocal<D>, k++);
    for (int l = 0; l < kVelocities<D>; ++l) v_a[l] = LocalDual<D>(va[l], kLocal<D>, k++);
    for (int l = 0; l < kPositions<D>; ++l) q_b[l] = LocalDual<D>(qb[l], kLocal<D>, k++);
    for (int l = 0; l < kVelocities<D>; ++l) v_b[l] = LocalDual<D>(vb[l], kLocal<D>, k++);
  }
};

}  // namespace

template <int D>
void ContactDae<D>::find_pattern() {
  std::vector<std::pair<int, int>> entries;
  const auto add_block = [&](Place rows, Place columns) {  // the velocity rows of one body against all of another
    for (int r = 0; r < rows.nv; ++r) {
      for (int k = 0; k < columns.nq; ++k) entries.emplace_back(rows.v + r, columns.q + k);
      for (int k = 0; k < columns.nv; ++k) entries.emplace_back(rows.v + r, columns.v + k);
    }
  };
  const auto add_row = [&](int row, Place columns) {
    for (int k = 0; k < columns.nq; ++k) entries.emplace_back(row, columns.q + k);
    for (int k = 0; k < columns.nv; ++k) entries.emplace_back(row, columns.v + k);
  };
  for (const Place at : places_) {
    for (int r = 0; r < at.nq; ++r) add_row(at.q + r, at);
    add_block(at, at);
  }
  for (int i = works_; i < num_states_ + num_algebraics(); ++i) entries.emplace_back(i, i);
  for (int i = 0; i < num_constraints(); ++i) {
    const Constraint<D>& c = scene_.constraints[static_cast<std::size_t>(i)];
    const int multiplier = num_states_ + i;
    for (const int body : {c.a, c.b}) {
      for (const int other : {c.a, c.b}) add_block(place(body), place(other));
      add_row(multiplier, place(body));
      for (int r = 0; r < place(body).nv; ++r) entries.emplace_back(place(body).v + r, multiplier);
      if (scene_.with_audit) add_row(works_ + i, place(body));
    }
    if (scene_.with_audit) entries.emplace_back(works_ + i, multiplier);
  }
  for (std::size_t k = 0; k < index_2_.size(); ++k) {
    const Constraint<D>& c = scene_.constraints[static_cast<std::size_t>(index_2_[k])];
    const int mu = num_states_ + num_constraints() + static_cast<int>(k);
    for (const int body : {c.a, c.b}) {
      const Place at = place(body);
      add_row(mu, at);
      for (int r = 0; r < at.nq; ++r) {
        for (const int other : {c.a, c.b}) add_row(at.q + r, place(other));
        entries.emplace_back(at.q + r, mu);
      }
    }
  }
  for (std::size_t k = 0; k < scene_.forces.size(); ++k) {
    const Force<D>& force = scene_.forces[k];
    for (const int body : {force.a, force.b}) {
      for (const int other : {force.a, force.b}) add_block(place(body), place(other));
      if (force_work_[k] >= 0) add_row(force_work_[k], place(body));
    }
  }
  const int n = num_states_ + num_algebraics();
  pattern_ = SparsePattern::from_entries(n, n, std::move(entries));
}

template <int D>
void ContactDae<D>::jacobian(const DaeMode& mode, const DaePoint& at, double alpha, Workspace& workspace, std::span<double> values) const {
  auto& bodies = static_cast<Bodies&>(*workspace);
  load(mode, at.t, at.x, bodies);
  std::fill(values.begin(), values.end(), 0.0);
  const auto add = [&](int row, int column, double value) { values[static_cast<std::size_t>(pattern_.find(row, column))] += value; };
  // the derivatives of one row, over the local positions and velocities of bodies a and b
  const auto add_local = [&](int row, Place a, Place b, const auto& gradient, double factor) {
    int k = 0;
    for (const Place body : {a, b}) {
      for (int l = 0; l < kPositions<D>; ++l, ++k) {
        if (l < body.nq) add(row, body.q + l, factor * gradient[k]);
      }
      for (int l = 0; l < kVelocities<D>; ++l, ++k) {
        if (l < body.nv) add(row, body.v + l, factor * gradient[k]);
      }
    }
  };

  const Place nowhere{0, 0, 0, 0};
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const Place p = places_[i];
    const LocalState<D> local(bodies.q[i], bodies.v[i], bodies.q.back(), bodies.v.back());
    const Positions<LocalDual<D>, D> rates = position_rates(local.q_a, local.v_a);
    for (int l = 0; l < p.nq; ++l) {
      add(p.q + l, p.q + l, alpha);
      add_local(p.q + l, p, nowhere, rates[l].derivatives(), -1);
    }
    for (int l = 0; l < p.nv; ++l) add(p.v + l, p.v + l, alpha / inverse_mass(static_cast<int>(i), l));
    if constexpr (D == 3) {
      if (p.nv < 6) continue;
      const Point<LocalDual<D>, 3> omega = local.v_a.template tail<3>();
      const Point<LocalDual<D>, 3> spin = scene_.bodies[i].inertia.template cast<LocalDual<D>>().cwiseProduct(omega);
      const Point<LocalDual<D>, 3> turn = cross(omega, spin);
      for (int l = 0; l < 3; ++l) add_local(p.v + 3 + l, p, nowhere, turn[l].derivatives(), 1);
    }
  }
  for (int i = works_; i < num_states_; ++i) add(i, i, alpha);

  for (std::size_t k = 0; k < scene_.forces.size(); ++k) {
    const Force<D>& force = scene_.forces[k];
    const Place a = place(force.a), b = place(force.b);
    const LocalState<D> local(of(bodies.q, force.a), of(bodies.v, force.a), of(bodies.q, force.b), of(bodies.v, force.b));
    const auto value = evaluate<LocalDual<D>, D>(force, at.t, local.q_a, local.v_a, local.q_b, local.v_b);
    for (int l = 0; l < a.nv; ++l) add_local(a.v + l, a, b, value.Q_A[l].derivatives(), -1);
    for (int l = 0; l < b.nv; ++l) add_local(b.v + l, a, b, value.Q_B[l].derivatives(), -1);
    if (force_work_[k] >= 0) add_local(force_work_[k], a, b, value.power.derivatives(), -1);
  }

  int mu = num_states_ + num_constraints();  // of the next joint of index 2
  for (int i = 0; i < num_constraints(); ++i) {
    const int multiplier = num_states_ + i, m = mode.discrete[static_cast<std::size_t>(i)];
    if (m != kContact && m != kCollision) {
      add(multiplier, multiplier, 1);
      continue;
    }
    const Constraint<D>& c = scene_.constraints[static_cast<std::size_t>(i)];
    const Place a = place(c.a), b = place(c.b);
    const LocalState<D> local(of(bodies.q, c.a), of(bodies.v, c.a), of(bodies.q, c.b), of(bodies.v, c.b));
    const Pose<LocalDual<D>, D> A(local.q_a, local.v_a), B(local.q_b, local.v_b);
    const Gap<D> gap = gap_at(c, of(bodies.poses, c.a), of(bodies.poses, c.b), bodies.features[static_cast<std::size_t>(i)]);
    const auto rows = constraint_rows<LocalDual<D>, D>(c, gap, at.t, A, B, local.q_a, local.q_b, at.y[i]);
    // forces and power are linear in lambda: their values at one unit are the column of lambda
    const auto unit =
        constraint_rows<double, D>(c, gap, at.t, of(bodies.poses, c.a), of(bodies.poses, c.b), of(bodies.q, c.a), of(bodies.q, c.b), 1.0);
    if (c.is_index_2()) {
      add_local(multiplier, a, b, rows.hdot.derivatives(), 1);
      add_local(mu, a, b, rows.h.derivatives(), 1);
      const auto add_travel = [&](int body, const auto& q, const auto& H) {  // E M^-1 H' mu
        const Velocities<LocalDual<D>, D> step = of(inverse_masses_, body).template cast<LocalDual<D>>().cwiseProduct(H);
        const Positions<LocalDual<D>, D> change = along(q, step);
        for (int l = 0; l < place(body).nq; ++l) {
          add_local(place(body).q + l, a, b, change[l].derivatives(), -at.y[mu - num_states_]);
          add(place(body).q + l, mu, -change[l].value());
        }
      };
      add_travel(c.a, local.q_a, rows.H_A);
      add_travel(c.b, local.q_b, rows.H_B);
      ++mu;
    } else {
      LocalDual<D> law = rows.law;
      for (int l = 0; l < a.nv; ++l) law += rows.H_A[l] * at.xdot[a.v + l], add(multiplier, a.v + l, alpha * unit.H_A[l]);
      for (int l = 0; l < b.nv; ++l) law += rows.H_B[l] * at.xdot[b.v + l], add(multiplier, b.v + l, alpha * unit.H_B[l]);
      add_local(multiplier, a, b, law.derivatives(), 1);
      add(multiplier, multiplier, softness(mode, c));
    }
    for (int l = 0; l < a.nv; ++l) {
      add(a.v + l, multiplier, -unit.on_a[l]);
      add_local(a.v + l, a, b, rows.on_a[l].derivatives(), -1);
    }
    for (int l = 0; l < b.nv; ++l) {
      add(b.v + l, multiplier, -unit.on_b[l]);
      add_local(b.v + l, a, b, rows.on_b[l].derivatives(), -1);
    }
    if (!scene_.with_audit) continue;
    add(works_ + i, multiplier, -unit.power);
    add_local(works_ + i, a, b, rows.power.derivatives(), -1);
  }
}

template class ContactDae<2>;
template class ContactDae<3>;

}  // namespace tenon::contact
