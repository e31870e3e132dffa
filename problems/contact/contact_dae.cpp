// The smooth part of ContactDae: bodies, forces, residual, the direct solve for accelerations and multipliers, guards and outputs.
#include "tenon/problems/contact/contact_dae.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "tenon/problems/contact/constraint_rows.hpp"
#include "tenon/problems/contact/features.hpp"

namespace tenon::contact {

namespace {

constexpr double kRank = 1e-11;  // of H M^-1 H': smaller pivots count as dependent contacts

const std::vector<std::string>& position_names(int dimension) {
  static const std::vector<std::string> planar{"x", "y", "theta"}, spatial{"x", "y", "z", "qw", "qx", "qy", "qz"};
  return dimension == 2 ? planar : spatial;
}
const std::vector<std::string>& velocity_names(int dimension) {
  static const std::vector<std::string> planar{"vx", "vy", "omega"}, spatial{"vx", "vy", "vz", "omegax", "omegay", "omegaz"};
  return dimension == 2 ? planar : spatial;
}

}  // namespace

template <int D>
ContactDae<D>::ContactDae(Scene<D> scene) : scene_(std::move(scene)) {
  check();
  for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
    const Body<D>& body = scene_.bodies[i];
    const Place place{num_states_, num_states_ + body.num_positions(), body.num_positions(), body.freedoms};
    const std::string number = std::to_string(i + 1);
    for (int l = 0; l < place.nq; ++l) state_names_.push_back(position_names(D)[static_cast<std::size_t>(l)] + number);
    for (int l = 0; l < place.nv; ++l) {
      const std::string& velocity = velocity_names(D)[static_cast<std::size_t>(l)];
      state_names_.push_back(velocity + number);
    }
    places_.push_back(place);
    Velocities<double, D> inverse = Velocities<double, D>::Zero();
    for (int l = 0; l < body.freedoms; ++l) inverse[l] = l < D ? 1 / body.mass : 1 / body.inertia[l - D];
    inverse_masses_.push_back(inverse);
    num_states_ += place.nq + place.nv;
  }
  inverse_masses_.push_back(Velocities<double, D>::Zero());
  is_ballistic_ = scene_.forces.empty() && std::none_of(places_.begin(), places_.end(), [](Place p) { return p.nv > 3; });
  works_ = num_states_;
  force_work_.assign(scene_.forces.size(), -1);
  if (scene_.with_audit) {
    for (const Constraint<D>& c : scene_.constraints) state_names_.push_back("work_" + c.name);
    num_states_ += static_cast<int>(scene_.constraints.size());
    for (std::size_t k = 0; k < scene_.forces.size(); ++k) {
      if (!scene_.forces[k].has_work()) continue;
      force_work_[k] = num_states_++;
      state_names_.push_back("work_" + scene_.forces[k].name);
    }
  }
  for (int i = 0; i < num_constraints(); ++i) {
    const Constraint<D>& c = scene_.constraints[static_cast<std::size_t>(i)];
    order_.push_back(i);
    if (!c.is_joint()) contacts_.push_back(i), reach_.push_back(reach(c));
    if (c.is_index_2()) index_2_.push_back(i);
    has_friction_ |= c.friction > 0;
    has_one_law_ |= !c.is_joint() && !c.is_two_scale;
    is_ballistic_ &= !c.is_joint();
  }
  const auto reach = [&](int i) {
    const Constraint<D>& c = scene_.constraints[static_cast<std::size_t>(i)];
    return std::pair(std::max(c.a, c.b), std::min(c.a, c.b));
  };
  std::stable_sort(order_.begin(), order_.end(), [&](int i, int j) { return reach(i) < reach(j); });
  find_pattern();
}

template <int D>
void ContactDae<D>::check() const {
  for (const Body<D>& body : scene_.bodies) {
    const bool turns = body.freedoms > D;
    if (!(body.mass > 0) || (turns && !(body.inertia.minCoeff() > 0))) {
      throw std::invalid_argument("body '" + body.name + "' has a singular mass matrix (expected mass and inertia above 0)");
    }
  }
}

template <int D>
Dae::Workspace ContactDae<D>::make_workspace() const {
  auto bodies = std::make_unique<Bodies>();
  const std::size_t n = scene_.bodies.size() + 1, m = scene_.constraints.size();  // the world stands last
  bodies->q.assign(n, Body<D>().q);
  bodies->v.assign(n, Velocities<double, D>::Zero());
  bodies->force = bodies->acceleration = bodies->travel = bodies->v;
  bodies->poses.assign(n, Pose<double, D>(Body<D>().q, Velocities<double, D>::Zero()));
  for (std::size_t i = 0; i < scene_.bodies.size(); ++i) bodies->q[i] = scene_.bodies[i].q;
  bodies->gaps.resize(m);
  bodies->push_a.assign(m, Velocities<double, D>::Zero());
  bodies->push_b = bodies->push_a;
  bodies->push_power.assign(m, 0);
  bodies->first_seen.resize(n);
  bodies->active.reserve(m);
  bodies->skyline.reserve(static_cast<int>(m));
  bodies->rhs.setZero(static_cast<int>(m));
  bodies->answer = bodies->lambda = bodies->rhs;
  bodies->touching.reserve(m);
  bodies->resting.reserve(m);
  bodies->trial.discrete.reserve(m);
  bodies->trial.held.resize(kHeldFeatures + static_cast<int>(m));
  bodies->features.assign(m, kNearest);
  return bodies;
}

template <int D>
void ContactDae<D>::initial_state(DaeState& state) const {
  for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
    const Place at = places_[i];
    state.x.segment(at.q, at.nq) = scene_.bodies[i].q.head(at.nq);
    state.x.segment(at.v, at.nv) = scene_.bodies[i].v.head(at.nv);
  }
  state.mode.discrete.assign(scene_.constraints.size(), kFree);
  for (std::size_t i = 0; i < scene_.constraints.size(); ++i) {
    if (scene_.constraints[i].is_joint()) state.mode.discrete[i] = kContact;
  }
  Workspace workspace = make_workspace();
  state.mode.held.setConstant(kHeldFeatures + num_constraints(), kNearest);
  state.mode.held[kHeldRedundant] = 0;
  state.mode.held[kHeldEnergy] = energy(state.t, state.x, workspace);
}

template <int D>
void ContactDae<D>::load(double t, ConstVectorRef x, Bodies& bodies) const {
  bodies.t = t;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const Place at = places_[i];
    for (int l = 0; l < at.nq; ++l) bodies.q[i][l] = x[at.q + l];
    for (int l = 0; l < at.nv; ++l) bodies.v[i][l] = x[at.v + l];
    Pose<double, D>& pose = bodies.poses[i];
    if (turns(at))
      pose = Pose<double, D>(bodies.q[i], bodies.v[i]);
    else
      pose.p = bodies.q[i].template head<D>(), pose.pdot = bodies.v[i].template head<D>();
  }
}

template <int D>
void ContactDae<D>::load(const DaeMode& mode, double t, ConstVectorRef x, Bodies& bodies) const {
  load(t, x, bodies);
  for (int i = 0; i < num_constraints(); ++i) bodies.features[static_cast<std::size_t>(i)] = static_cast<int>(mode.held[kHeldFeatures + i]);
}

template <int D>
double ContactDae<D>::softness(const DaeMode& mode, const Constraint<D>& c) const {
  return mode.held[kHeldRedundant] == 0 ? 0 : kSoftness * (inverse_mass(c.a, 0) + inverse_mass(c.b, 0));
}

namespace {

/// Gravity and, in space, -omega x J omega in body axes.
template <int D>
Velocities<double, D> own_force(const Body<D>& body, const Point<double, D>& gravity, const Velocities<double, D>& v) {
  Velocities<double, D> Q = Velocities<double, D>::Zero();
  Q.template head<D>() = body.mass * gravity;
  if constexpr (D == 3) {
    const Point<double, 3> omega = v.template tail<3>(), spin = body.inertia.cwiseProduct(omega);
    Q.template tail<3>() = -cross(omega, spin);
  }
  return Q;
}

}  // namespace

template <int D>
void ContactDae<D>::apply_forces(double t, Bodies& bodies, double* powers) const {
  for (std::size_t i = 0; i < scene_.bodies.size(); ++i) bodies.force[i] = own_force(scene_.bodies[i], scene_.gravity, bodies.v[i]);
  for (std::size_t k = 0; k < scene_.forces.size(); ++k) {
    const Force<D>& force = scene_.forces[k];
    const auto value =
        evaluate<double, D>(force, t, of(bodies.q, force.a), of(bodies.v, force.a), of(bodies.q, force.b), of(bodies.v, force.b));
    of(bodies.force, force.a) += value.Q_A;
    of(bodies.force, force.b) += value.Q_B;
    if (powers != nullptr && force_work_[k] >= 0) powers[force_work_[k]] = value.power;
  }
}

template <int D>
GapValue<double, D> ContactDae<D>::gap_of(int constraint, double t, const Bodies& bodies) const {
  const Constraint<D>& c = scene_.constraints[static_cast<std::size_t>(constraint)];
  const Pose<double, D>&A = of(bodies.poses, c.a), &B = of(bodies.poses, c.b);
  return evaluate_gap<double, D>(gap_at(c, A, B, bodies.features[static_cast<std::size_t>(constraint)]), t, A, B, of(bodies.q, c.a),
                                 of(bodies.q, c.b));
}

template <int D>
GapValue<double, D> ContactDae<D>::gap(int constraint, double t, ConstVectorRef x, Workspace& workspace) const {
  auto& bodies = static_cast<Bodies&>(*workspace);
  load(t, x, bodies);
  std::fill(bodies.features.begin(), bodies.features.end(), kNearest);
  return gap_of(constraint, t, bodies);
}

/// Factors of H M^-1 H' + r over the active constraints.
template <int D>
void ContactDae<D>::factorise(const DaeMode& mode, double t, Bodies& bodies) const {
  bodies.active.clear();
  for (const int i : order_) {
    const int m = mode.discrete[static_cast<std::size_t>(i)];
    if (m != kContact && m != kCollision) continue;
    bodies.active.push_back(i);
    const Constraint<D>& c = scene_.constraints[static_cast<std::size_t>(i)];
    auto& g = bodies.gaps[static_cast<std::size_t>(i)];
    g = gap_of(i, t, bodies);
    push_of<double, D>(c, g, of(bodies.poses, c.a), of(bodies.poses, c.b), bodies.push_a[static_cast<std::size_t>(i)],
                       bodies.push_b[static_cast<std::size_t>(i)], bodies.push_power[static_cast<std::size_t>(i)]);
  }
  const int k = static_cast<int>(bodies.active.size());
  if (k == 0) return;

  bodies.skyline.clear();
  if (has_friction_) bodies.dense.setZero(k, k);
  std::fill(bodies.first_seen.begin(), bodies.first_seen.end(), k);
  // a' M^-1 b of two generalised forces on one body
  const auto product = [&](int body, const Velocities<double, D>& a, const Velocities<double, D>& b) {
    const Velocities<double, D>& inverse = of(inverse_masses_, body);
    double sum = 0;
    for (int l = 0; l < kVelocities<D>; ++l) sum += a[l] * inverse[l] * b[l];
    return sum;
  };
  for (int row = 0; row < k; ++row) {
    const int i = bodies.active[static_cast<std::size_t>(row)];
    const Constraint<D>& c = scene_.constraints[static_cast<std::size_t>(i)];
    const auto& g = bodies.gaps[static_cast<std::size_t>(i)];
    int first = row;
    for (const int body : {c.a, c.b}) {
      if (body == kWorld) continue;
      int& seen = bodies.first_seen[static_cast<std::size_t>(body)];
      seen = std::min(seen, row);
      first = std::min(first, seen);
    }
    bodies.skyline.add_row(first);
    for (int column = has_friction_ ? 0 : first; column <= (has_friction_ ? k - 1 : row); ++column) {
      const int j = bodies.active[static_cast<std::size_t>(column)];
      const Constraint<D>& d = scene_.constraints[static_cast<std::size_t>(j)];
      const auto &on_a = bodies.push_a[static_cast<std::size_t>(j)], &on_b = bodies.push_b[static_cast<std::size_t>(j)];
      double sum = 0;
      if (c.a == d.a) sum += product(c.a, g.H_A, on_a);
      if (c.a == d.b) sum += product(c.a, g.H_A, on_b);
      if (c.b == d.a) sum += product(c.b, g.H_B, on_a);
      if (c.b == d.b) sum += product(c.b, g.H_B, on_b);
      if (column == row) sum += softness(mode, c);
      if (has_friction_)
        bodies.dense(row, column) = sum;
      else
        bodies.skyline(row, column) = sum;
    }
  }
  if (has_friction_) {
    bodies.lu.compute(bodies.dense);
    bodies.defect = bodies.lu.matrixLU().diagonal().cwiseAbs().minCoeff() <= kRank * bodies.dense.diagonal().cwiseAbs().maxCoeff();
  } else {
    bodies.defect = bodies.skyline.factorise(kRank);
  }
}

/// rhs, in the order of the active constraints, is solved for lambda; 0 elsewhere.
template <int D>
void ContactDae<D>::solve(Bodies& bodies) const {
  bodies.lambda.setZero();
  const int k = static_cast<int>(bodies.active.size());
  if (k == 0) return;
  if (has_friction_) {
    bodies.answer.head(k) = bodies.lu.solve(bodies.rhs.head(k));
  } else {
    bodies.answer.head(k) = bodies.rhs.head(k);
    bodies.skyline.solve(bodies.answer.head(k));
  }
  for (int row = 0; row < k; ++row) bodies.lambda[bodies.active[static_cast<std::size_t>(row)]] = bodies.answer[row];
}

/// (H M^-1 H' + r) lambda = -(Hdot v + alpha1 h' + alpha0 h + alpha3 h^3) - H M^-1 Q over the active constraints.   (3)
template <int D>
void ContactDae<D>::solve_multipliers(const DaeMode& mode, double t, Bodies& bodies) const {
  for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
    bodies.acceleration[i] = inverse_masses_[i].cwiseProduct(bodies.force[i]);
  }
  factorise(mode, t, bodies);
  for (std::size_t row = 0; row < bodies.active.size(); ++row) {
    const std::size_t i = static_cast<std::size_t>(bodies.active[row]);
    const Constraint<D>& c = scene_.constraints[i];
    const GapValue<double, D>& g = bodies.gaps[i];
    bodies.rhs[static_cast<int>(row)] =
        c.law.acceleration(g.h, g.hdot) - g.bias - g.H_A.dot(of(bodies.acceleration, c.a)) - g.H_B.dot(of(bodies.acceleration, c.b));
  }
  solve(bodies);
}

/// vdot = M^-1 (Q + sum H' lambda), on top of M^-1 Q which stands there already.
template <int D>
void ContactDae<D>::set_accelerations(Bodies& bodies) const {
  for (const int i : bodies.active) {
    const Constraint<D>& c = scene_.constraints[static_cast<std::size_t>(i)];
    const double lambda = bodies.lambda[i];
    of(bodies.acceleration, c.a) += lambda * of(inverse_masses_, c.a).cwiseProduct(bodies.push_a[static_cast<std::size_t>(i)]);
    of(bodies.acceleration, c.b) += lambda * of(inverse_masses_, c.b).cwiseProduct(bodies.push_b[static_cast<std::size_t>(i)]);
  }
}

template <int D>
void ContactDae<D>::derivatives(const DaeMode& mode, double t, ConstVectorRef x, ConstVectorRef, Workspace& workspace, VectorRef xdot,
                                VectorRef y) const {
  auto& bodies = static_cast<Bodies&>(*workspace);
  load(mode, t, x, bodies);
  if (scene_.with_audit) xdot.tail(num_states_ - works_).setZero();
  apply_forces(t, bodies, xdot.data());
  solve_multipliers(mode, t, bodies);
  set_accelerations(bodies);
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const Place at = places_[i];
    xdot.segment(at.q, at.nq) = position_rates(bodies.q[i], bodies.v[i]).head(at.nq);
    xdot.segment(at.v, at.nv) = bodies.acceleration[i].head(at.nv);
  }
  y.head(num_constraints()) = bodies.lambda;
  y.tail(num_algebraics() - num_constraints()).setZero();  // mu, where x is on its manifold
  if (!scene_.with_audit) return;
  for (const int i : bodies.active) xdot[works_ + i] = bodies.lambda[i] * bodies.push_power[static_cast<std::size_t>(i)];
}

template <int D>
void ContactDae<D>::residual(const DaeMode& mode, const DaePoint& at, Workspace& workspace, VectorRef F) const {
  auto& bodies = static_cast<Bodies&>(*workspace);
  load(mode, at.t, at.x, bodies);
  if (scene_.with_audit) F.segment(works_, num_states_ - works_).setZero();
  apply_forces(at.t, bodies, F.data());
  if (scene_.with_audit) {
    F.segment(works_, num_states_ - works_) = at.xdot.tail(num_states_ - works_) - F.segment(works_, num_states_ - works_);
  }
  std::copy(bodies.v.begin(), bodies.v.end(), bodies.travel.begin());
  for (std::size_t k = 0; k < index_2_.size(); ++k) {
    const int i = index_2_[k], mu = num_constraints() + static_cast<int>(k);
    const Constraint<D>& c = scene_.constraints[static_cast<std::size_t>(i)];
    const GapValue<double, D> g = gap_of(i, at.t, bodies);
    of(bodies.travel, c.a) += at.y[mu] * of(inverse_masses_, c.a).cwiseProduct(g.H_A);
    of(bodies.travel, c.b) += at.y[mu] * of(inverse_masses_, c.b).cwiseProduct(g.H_B);
    F[num_states_ + mu] = g.h;
  }
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const Place p = places_[i];
    F.segment(p.q, p.nq) = at.xdot.segment(p.q, p.nq) - position_rates(bodies.q[i], bodies.travel[i]).head(p.nq);
    for (int l = 0; l < p.nv; ++l) F[p.v + l] = at.xdot[p.v + l] / inverse_mass(static_cast<int>(i), l) - bodies.force[i][l];
  }
  for (int i = 0; i < num_constraints(); ++i) {
    const int m = mode.discrete[static_cast<std::size_t>(i)];
    F[num_states_ + i] = at.y[i];
    if (m != kContact && m != kCollision) continue;
    const Constraint<D>& c = scene_.constraints[static_cast<std::size_t>(i)];
    const Place a = place(c.a), b = place(c.b);
    const Pose<double, D>&A = of(bodies.poses, c.a), &B = of(bodies.poses, c.b);
    const auto rows = constraint_rows<double, D>(c, gap_at(c, A, B, bodies.features[static_cast<std::size_t>(i)]), at.t, A, B,
                                                 of(bodies.q, c.a), of(bodies.q, c.b), at.y[i]);
    double row = rows.law + softness(mode, c) * at.y[i];
    for (int l = 0; l < a.nv; ++l) F[a.v + l] -= rows.on_a[l], row += rows.H_A[l] * at.xdot[a.v + l];
    for (int l = 0; l < b.nv; ++l) F[b.v + l] -= rows.on_b[l], row += rows.H_B[l] * at.xdot[b.v + l];
    F[num_states_ + i] = c.is_index_2() ? rows.hdot : row;
    if (scene_.with_audit) F[works_ + i] -= rows.power;
  }
}

template class ContactDae<2>;
template class ContactDae<3>;

}  // namespace tenon::contact
