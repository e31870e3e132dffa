// The state machine of the contacts, and what becomes of the velocities at an event. All tests are on levels, so that a start exactly
// touching, or a restart, is treated as an event would be.
//
//     free -> collision     h <= 0 and closing; two-scale: the fast phase happens here and now, q stands still
//     collision -> contact  two-scale: the rebound is slower than rest_speed; one-law: |h'| and |h''| are small and lambda > 0
//     -> free               lambda < 0
//     touching, at rest     lambda >= 0, h'' >= 0, lambda h'' = 0 over all such contacts at once  (distribute)
#include <algorithm>
#include <array>
#include <cmath>

#include "tenon/problems/contact/contact_dae.hpp"
#include "tenon/problems/contact/features.hpp"

namespace tenon::contact {

namespace {

constexpr double kClosed = 1e-11;  // m: gaps up to here collide

/// Unit vectors across the normal.
std::array<Point<double, 2>, 1> tangents_of(const Point<double, 2>& n) {
  return {Point<double, 2>(-n[1], n[0])};
}
std::array<Point<double, 3>, 2> tangents_of(const Point<double, 3>& n) {
  const Point<double, 3> first = n.unitOrthogonal(), second = n.cross(first);
  return {first, second};
}

}  // namespace

template <int D>
Transition ContactDae<D>::transition(DaeState& state, std::span<const int> fired, Workspace& workspace, const EventLog& log) const {
  auto& bodies = static_cast<Bodies&>(*workspace);
  load(state.mode, state.t, state.x, bodies);
  const Transition transition = react(state, fired, bodies, log);
  if (transition.changed) hold_features(state, bodies);
  return transition;
}

template <int D>
Transition ContactDae<D>::react(DaeState& state, std::span<const int> fired, Bodies& bodies, const EventLog& log) const {
  if (pass_features(state, fired, bodies)) return {.changed = true};
  if (release(state, fired, bodies, log)) return {.changed = true};
  if (settle_one_law(state, bodies, log)) return {.changed = true};
  if (begin_one_law(state, bodies, log)) return {.changed = true};
  const Transition collision = collide(state, bodies, log);
  if (collision.changed || !collision.failure.empty()) return collision;
  return distribute(state, bodies, log);
}

/// Contacts that have slid to the end of their feature go on to the next.
template <int D>
bool ContactDae<D>::pass_features(DaeState& state, std::span<const int> fired, const Bodies& bodies) const {
  bool is_changed = false;
  for (const int guard : fired) {
    const int i = guard / 2;
    if (guard % 2 == 0 || state.mode.discrete[static_cast<std::size_t>(i)] != kContact) continue;
    const Constraint<D>& c = scene_.constraints[static_cast<std::size_t>(i)];
    int next = kNearest;
    inside_feature(c, bodies.features[static_cast<std::size_t>(i)], seen_from(c, of(bodies.poses, c.a), of(bodies.poses, c.b)), next);
    state.mode.held[kHeldFeatures + i] = next;
    is_changed = true;
  }
  return is_changed;
}

/// A contact that has come to hold something holds the feature that is nearest; one that is off, none.
template <int D>
void ContactDae<D>::hold_features(DaeState& state, const Bodies& bodies) const {
  for (const int i : contacts_) {
    const Constraint<D>& c = scene_.constraints[static_cast<std::size_t>(i)];
    double& held = state.mode.held[kHeldFeatures + i];
    if (c.shape.vertices.empty()) continue;
    if (state.mode.discrete[static_cast<std::size_t>(i)] != kContact)
      held = kNearest;
    else if (held == kNearest)
      held = nearest_feature(c, seen_from(c, of(bodies.poses, c.a), of(bodies.poses, c.b)));
  }
}

template <int D>
void ContactDae<D>::report(const DaeState& state, int constraint, int from, int to, const Bodies& bodies, double rate_after, double impulse,
                           double energy_after, const EventLog& log) const {
  const GapValue<double, D> g = gap_of(constraint, state.t, bodies);
  log({state.t, scene_.constraints[static_cast<std::size_t>(constraint)].name, from, to, g.h, g.hdot, rate_after, impulse,
       energy_of(state.t, bodies), energy_after});
}

/// h'' of a constraint under the accelerations that stand in the workspace.
template <int D>
double ContactDae<D>::acceleration(int constraint, const Bodies& bodies) const {
  const Constraint<D>& c = scene_.constraints[static_cast<std::size_t>(constraint)];
  const GapValue<double, D> g = gap_of(constraint, bodies.t, bodies);
  return g.bias + g.H_A.dot(of(bodies.acceleration, c.a)) + g.H_B.dot(of(bodies.acceleration, c.b));
}

/// Contacts whose multiplier has fallen to zero.
template <int D>
bool ContactDae<D>::release(DaeState& state, std::span<const int> fired, const Bodies& bodies, const EventLog& log) const {
  bool is_changed = false;
  for (const int i : contacts_) {
    int& mode = state.mode.discrete[static_cast<std::size_t>(i)];
    const bool has_fired = std::find(fired.begin(), fired.end(), 2 * i) != fired.end();
    const bool lets_go = (mode == kContact && has_fired) || (mode == kCollision && (has_fired || state.y[i] < 0));
    if (!lets_go) continue;
    const double energy = energy_of(state.t, bodies);
    const GapValue<double, D> g = gap_of(i, state.t, bodies);
    report(state, i, mode, kFree, bodies, g.hdot, 0, energy, log);
    mode = kFree;
    is_changed = true;
  }
  return is_changed;
}

template <int D>
bool ContactDae<D>::begin_one_law(DaeState& state, const Bodies& bodies, const EventLog& log) const {
  bool is_changed = false;
  for (const int i : contacts_) {
    const Constraint<D>& c = scene_.constraints[static_cast<std::size_t>(i)];
    int& mode = state.mode.discrete[static_cast<std::size_t>(i)];
    if (c.is_two_scale || mode != kFree) continue;
    const GapValue<double, D> g = gap_of(i, state.t, bodies);
    if (g.h > kClosed || g.hdot >= -kSpeedTolerance) continue;
    // where the free motion opens faster than the law would, the law would have to pull
    if (acceleration(c, g, state.xdot) >= c.law.acceleration(g.h, g.hdot)) continue;
    const int next = -g.hdot < c.rest_speed ? kContact : kCollision;
    report(state, i, mode, next, bodies, g.hdot, 0, energy_of(state.t, bodies), log);
    mode = next;
    is_changed = true;
  }
  return is_changed;
}

template <int D>
bool ContactDae<D>::settle_one_law(DaeState& state, const Bodies& bodies, const EventLog& log) const {
  bool is_changed = false;
  for (const int i : contacts_) {
    int& mode = state.mode.discrete[static_cast<std::size_t>(i)];
    if (mode != kCollision || !(state.y[i] > 0)) continue;
    const Constraint<D>& c = scene_.constraints[static_cast<std::size_t>(i)];
    const GapValue<double, D> g = gap_of(i, state.t, bodies);
    const double hddot = c.law.acceleration(g.h, g.hdot);
    // the guard located this on its own scale: a hair above its threshold is on it
    if (std::pow(g.hdot / c.rest_speed, 2) + std::pow(hddot / c.rest_acceleration, 2) > 1 + 1e-6) continue;
    report(state, i, mode, kContact, bodies, g.hdot, 0, energy_of(state.t, bodies), log);
    mode = kContact;
    is_changed = true;
  }
  return is_changed;
}

/// All closing two-scale contacts at once: the fast phase in the space of the touching contacts, joints held.
template <int D>
Transition ContactDae<D>::collide(DaeState& state, Bodies& bodies, const EventLog& log) const {
  std::vector<int>& touching = bodies.touching;
  touching.clear();
  bool is_closing = false;
  for (const int i : contacts_) {
    const Constraint<D>& c = scene_.constraints[static_cast<std::size_t>(i)];
    if (!c.is_two_scale) continue;
    const GapValue<double, D> g = gap_of(i, state.t, bodies);
    if (g.h > kTouching) continue;
    touching.push_back(i);
    is_closing |= g.h <= kClosed && g.hdot < -kSpeedTolerance && state.mode.discrete[static_cast<std::size_t>(i)] != kContact;
  }
  if (!is_closing) return {};

  // the joints' factor of H_j M^-1 H_j', left in the workspace by the solve
  DaeMode joints_only = state.mode;
  for (const int i : contacts_) joints_only.discrete[static_cast<std::size_t>(i)] = kFree;
  apply_forces(state.t, bodies, nullptr);
  solve_multipliers(joints_only, state.t, bodies);
  const std::vector<int> joints = bodies.active;

  // one row for each normal, then those of the tangents where there is friction
  struct Row {
    int constraint;
    Velocities<double, D> H_A, H_B;
    double rate;
  };
  std::vector<Row> rows, held;
  const int k = static_cast<int>(touching.size()), tangents = has_friction_ ? D - 1 : 0;
  std::vector<double> gaps;
  for (const int i : touching) {
    const GapValue<double, D> g = gap_of(i, state.t, bodies);
    rows.push_back({i, g.H_A, g.H_B, g.hdot});
    gaps.push_back(g.h);
  }
  for (int c = 0; c < k && tangents > 0; ++c) {
    const int i = touching[static_cast<std::size_t>(c)];
    const Constraint<D>& contact = scene_.constraints[static_cast<std::size_t>(i)];
    const GapValue<double, D> g = gap_of(i, state.t, bodies);
    const Point<double, D> arm_a = g.at_a - contact.radius_a * g.normal, arm_b = g.at_b - contact.radius_a * g.normal;
    for (const Point<double, D>& direction : tangents_of(g.normal)) {
      const Point<double, D> opposite = -direction;
      const Velocities<double, D> on_a = of(bodies.poses, contact.a).force(arm_a, direction),
                                  on_b = of(bodies.poses, contact.b).force(arm_b, opposite);
      rows.push_back({i, on_a, on_b, on_a.dot(of(bodies.v, contact.a)) + on_b.dot(of(bodies.v, contact.b))});
    }
  }
  for (const int j : joints) {
    const auto& g = bodies.gaps[static_cast<std::size_t>(j)];
    held.push_back({j, g.H_A, g.H_B, g.rate});
  }
  const auto product = [&](const Row& r, const Row& s) {  // H_r M^-1 H_s'
    const Constraint<D>&first = scene_.constraints[static_cast<std::size_t>(r.constraint)],
          &second = scene_.constraints[static_cast<std::size_t>(s.constraint)];
    double sum = 0;
    for (const auto& [body, H] : {std::pair(first.a, &r.H_A), std::pair(first.b, &r.H_B)}) {
      for (const auto& [other, K] : {std::pair(second.a, &s.H_A), std::pair(second.b, &s.H_B)}) {
        if (body != other) continue;
        for (int l = 0; l < place(body).nv; ++l) sum += (*H)[l] * inverse_mass(body, l) * (*K)[l];
      }
    }
    return sum;
  };
  const int n = static_cast<int>(rows.size()), m = static_cast<int>(held.size());
  Eigen::MatrixXd A(n, n), coupling(m, n), answer(m, n);
  Vector rates(n);
  for (int c = 0; c < n; ++c) {
    rates[c] = rows[static_cast<std::size_t>(c)].rate;
    for (int d = 0; d < n; ++d) A(c, d) = product(rows[static_cast<std::size_t>(c)], rows[static_cast<std::size_t>(d)]);
    for (int j = 0; j < m; ++j) coupling(j, c) = product(held[static_cast<std::size_t>(j)], rows[static_cast<std::size_t>(c)]);
    answer.col(c) = coupling.col(c);
    if (m == 0) continue;
    if (has_friction_)
      answer.col(c) = bodies.lu.solve(coupling.col(c));
    else
      bodies.skyline.solve(answer.col(c));
  }
  if (m > 0) A -= coupling.transpose() * answer;

  std::vector<Touching> contacts;
  for (const int i : touching) {
    const Constraint<D>& c = scene_.constraints[static_cast<std::size_t>(i)];
    const bool is_held = state.mode.discrete[static_cast<std::size_t>(i)] == kContact;
    contacts.push_back({c.restitution, c.contact_time, c.rest_speed, c.friction, c.collision, is_held});
  }
  const FastPhase phase = resolve(scene_.impact_law, A, rates, contacts, tangents);
  if (!phase.failure.empty()) {
    std::string names;
    for (const int i : touching) names += " " + scene_.constraints[static_cast<std::size_t>(i)].name;
    return {false, phase.failure + ", contacts:" + names};
  }

  // v+ = v + M^-1 (H_T' p - H_j' (H_j M^-1 H_j')^-1 H_j M^-1 H_T' p)
  double energy = energy_of(state.t, bodies);
  for (const MicroEvent& event : phase.events) {
    const int i = touching[static_cast<std::size_t>(event.contact)];
    const double gap = gaps[static_cast<std::size_t>(event.contact)];
    log({state.t, scene_.constraints[static_cast<std::size_t>(i)].name, kFree, kCollision, gap, event.rate_before, event.rate_after,
         event.impulse, energy, energy + event.work});
    energy += event.work;
  }
  const auto push = [&](const Row& row, double impulse) {
    const Constraint<D>& c = scene_.constraints[static_cast<std::size_t>(row.constraint)];
    for (int l = 0; l < place(c.a).nv; ++l) state.x[place(c.a).v + l] += inverse_mass(c.a, l) * row.H_A[l] * impulse;
    for (int l = 0; l < place(c.b).nv; ++l) state.x[place(c.b).v + l] += inverse_mass(c.b, l) * row.H_B[l] * impulse;
  };
  for (int c = 0; c < n; ++c) {
    push(rows[static_cast<std::size_t>(c)], phase.impulses[c]);
    if (scene_.with_audit) state.x[works_ + rows[static_cast<std::size_t>(c)].constraint] += phase.works[c];
  }
  const Vector reaction = m > 0 ? Vector(-answer * phase.impulses) : Vector(0);
  for (int j = 0; j < m; ++j) {  // a driven joint works while it is struck
    push(held[static_cast<std::size_t>(j)], reaction[j]);
    if (scene_.with_audit) state.x[works_ + joints[static_cast<std::size_t>(j)]] += reaction[j] * held[static_cast<std::size_t>(j)].rate;
  }
  for (int c = 0; c < k; ++c) {
    const int i = touching[static_cast<std::size_t>(c)];
    int& mode = state.mode.discrete[static_cast<std::size_t>(i)];
    const int next = phase.is_held[static_cast<std::size_t>(c)] ? kContact : kFree;
    const int from = phase.impulses[c] > 0 && mode != kContact ? kCollision : mode;
    if (from != next) {
      log({state.t, scene_.constraints[static_cast<std::size_t>(i)].name, from, next, gaps[static_cast<std::size_t>(c)], phase.rates[c],
           phase.rates[c], phase.impulses[c], energy, energy});
    }
    mode = next;
  }
  return {.changed = true};
}

/// Which contacts that touch and stand still carry a force: principal pivoting on lambda >= 0, h'' >= 0, lambda h'' = 0.
/// Source: K. G. Murty, Note on a Bard-type scheme for solving the complementarity problem, Opsearch 11 (1974).
template <int D>
Transition ContactDae<D>::distribute(DaeState& state, Bodies& bodies, const EventLog& log) const {
  std::vector<int>& candidates = bodies.resting;
  candidates.clear();
  bool is_settled = true;
  for (const int i : contacts_) {
    const int mode = state.mode.discrete[static_cast<std::size_t>(i)];
    if (mode == kCollision) continue;
    if (mode == kContact) {
      candidates.push_back(i);
      is_settled &= state.y[i] >= 0;
      continue;
    }
    const GapValue<double, D> g = gap_of(i, state.t, bodies);
    if (std::abs(g.h) > kTouching || std::abs(g.hdot) > 2 * kSpeedTolerance) continue;
    candidates.push_back(i);
    is_settled = false;
  }
  if (is_settled && candidates.empty() && state.mode.held[kHeldRedundant] == 0 && bodies.defect == 0) return {};
  DaeMode& trial = bodies.trial;
  trial = state.mode;
  const auto solve = [&] {
    apply_forces(state.t, bodies, nullptr);
    trial.held[kHeldRedundant] = 0;
    solve_multipliers(trial, state.t, bodies);
    if (bodies.defect > 0 && !bodies.active.empty()) {
      trial.held[kHeldRedundant] = 1;
      solve_multipliers(trial, state.t, bodies);
    }
    set_accelerations(bodies);
  };
  solve();
  const int most = 20 + 20 * static_cast<int>(candidates.size());
  for (int k = 0; k < most && !is_settled; ++k) {
    const bool takes_first = k > most / 2;  // the lowest index does not cycle
    int worst = -1;
    double violation = 0;
    for (const int i : candidates) {
      const Constraint<D>& c = scene_.constraints[static_cast<std::size_t>(i)];
      const bool is_active = trial.discrete[static_cast<std::size_t>(i)] == kContact;
      const double lightness = inverse_mass(c.a, 0) + inverse_mass(c.b, 0);
      const double bad =
          is_active ? 0.5 * kAccelerationTolerance - bodies.lambda[i] * lightness : -acceleration(i, bodies) - kAccelerationTolerance;
      if (bad <= 0 || (worst >= 0 && (takes_first || bad <= violation))) continue;
      worst = i, violation = bad;
    }
    if (worst < 0) break;
    int& mode = trial.discrete[static_cast<std::size_t>(worst)];
    mode = mode == kContact ? kFree : kContact;
    solve();
  }
  if (trial == state.mode) return {};
  const double energy = energy_of(state.t, bodies);
  for (const int i : candidates) {
    const int from = state.mode.discrete[static_cast<std::size_t>(i)], to = trial.discrete[static_cast<std::size_t>(i)];
    if (from == to) continue;
    report(state, i, from, to, bodies, gap_of(i, state.t, bodies).hdot, 0, energy, log);
  }
  state.mode = trial;
  return {.changed = true};
}

template class ContactDae<2>;
template class ContactDae<3>;

}  // namespace tenon::contact
