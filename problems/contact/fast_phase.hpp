// The fast phase: collisions while the configuration stands still, in the space of the touching contacts.
//
//     A = H P H'      H the touching contacts' gradients, P = M^-1 - M^-1 H_j'(H_j M^-1 H_j')^-1 H_j M^-1 with the joints j held
//     w = H v         closing speeds;  an impulse p makes w+ = w + A p
//
// A collision of contact n with the contacts a held:  m_n = 1 / (A_nn - A_na A_aa^-1 A_an),  p_n = -(1 + e) m_n w_n,  p_a = -A_aa^-1 A_an
// p_n.   (16) A held contact that would have to pull lets go, and the collision is taken again without it. Where all that still closes is
// slower than its rest_speed, the rest of the phase is one blow without rebound:  p >= 0, w + A p >= 0, p'(w + A p) = 0.   (17) With
// friction the rows of the normals are followed by those of the tangents, `tangents` for each contact: they stick where |p_t| <= mu p_n
// allows, else p_t = mu p_n against the sliding; `compliant` asks so at each of its steps. Laws: see ImpactLaw in scene.hpp.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tenon/core/eigen.hpp"
#include "tenon/problems/contact/collision.hpp"
#include "tenon/problems/contact/scene.hpp"

namespace tenon::contact {

inline constexpr int kMostMicroEvents = 1000;

/// One touching contact, as the fast phase sees it.
struct Touching {
  double restitution = 1, contact_time = 1e-3, rest_speed = 1e-3, friction = 0;
  Law collision = {};    // with a cubic term: in place of restitution and contact_time
  bool is_held = false;  // carries a force: it must not open nor close, unless it would have to pull
};

/// One collision within the fast phase.
struct MicroEvent {
  int contact;  // among the touching ones
  double time;  // s, in the fast phase's own scale, at release
  double rate_before, rate_after;
  double impulse;  // N s
  double work;     // J, of all impulses of this collision
};

struct FastPhase {
  Vector rates;               // w+
  Vector impulses;            // of every row, N s
  Vector works;               // of every row, J
  std::vector<char> is_held;  // afterwards
  std::vector<MicroEvent> events;
  std::string failure;  // not empty where kMostMicroEvents did not end it
};

/// Resolves all closing contacts. A is symmetric positive semi-definite; it and w have k (1 + tangents) rows for k touching contacts.
FastPhase resolve(ImpactLaw law, const Eigen::MatrixXd& A, const Vector& w, const std::vector<Touching>& touching, int tangents = 0);

}  // namespace tenon::contact
