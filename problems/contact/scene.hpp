// A scene as data: bodies, what holds them together, what they may touch, what pushes them. ContactDae gives it equations.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tenon/problems/contact/expression.hpp"
#include "tenon/problems/contact/gap.hpp"
#include "tenon/problems/contact/law.hpp"

namespace tenon::contact {

inline constexpr int kWorld = -1;  // the body that never moves

/// Freedoms in the order x, y, theta of a planar body (1: a line, 2: a point, 3: rigid), or 3 and 6 of a spatial one.
template <int D>
struct Body {
  std::string name;
  int freedoms = 3;
  double mass = 1;                                   // kg
  Eigen::Matrix<double, D == 2 ? 1 : 3, 1> inertia;  // kg m^2, about the centre; in space about the body's axes
  Positions<double, D> q;                            // at the start; those it has not are fixed
  Velocities<double, D> v;

  Body() {
    inertia.setOnes();
    q.setZero(), v.setZero();
    if constexpr (D == 3) q[3] = 1;
  }
  int num_positions() const { return D == 3 && freedoms == 6 ? 7 : freedoms; }
};

/// The convex shapes that a point or ball may touch: in the plane a face (one vertex and `normal`), a segment (two vertices) or a polygon
/// (counter-clockwise); in space a half-space, an edge with round ends (two vertices) or a box (its centre and half its sides).
template <int D>
struct Convex {
  std::vector<Point<double, D>> vertices;              // in the body's axes
  Point<double, D> normal = Point<double, D>::Zero();  // of a face without end
  Point<double, D> half = Point<double, D>::Zero();    // of a box
  const Point<double, D>& vertex(int k) const { return vertices[static_cast<std::size_t>(k) % vertices.size()]; }
  bool is_face() const { return normal.squaredNorm() > 0; }
  bool is_box() const { return half.squaredNorm() > 0; }
};

enum class ConstraintKind { joint, contact };

/// What keeps a joint closed: Baumgarte's terms in its second derivative, or its equation and that of its rate themselves (index 2).
enum class Stabilisation { baumgarte, gear_gupta_leimkuhler };

/// One multiplier: a joint's equation, or a contact between one point (or ball) of body A and one convex shape of body B.
template <int D>
struct Constraint {
  std::string name;
  ConstraintKind kind = ConstraintKind::contact;
  int a = kWorld, b = kWorld;
  Gap<D> gap;           // as it stands for a joint, a rope or a ball on a ball; else its kind, b, n and offset follow from `shape`
  Convex<D> shape;      // of body B; without vertices the gap is what it is
  double radius_a = 0;  // m: of the ball that A is
  double radius = 0;    // m: of both together

  Law law;                          // of the contact in scene time: alpha; of a joint: Baumgarte's terms, or 0 where it is of index 2
  bool is_two_scale = true;         // collisions in a fast phase of their own
  double restitution = 1;           // of a collision, in [0, 1]
  double contact_time = 1e-3;       // s, of a collision: how long its fast phase lasts
  Law collision;                    // with a cubic term: in place of restitution and contact_time
  double rest_speed = 1e-3;         // m/s: slower rebounds stay in contact
  double rest_acceleration = 1e-2;  // m/s^2: of a one-law contact, with rest_speed
  double friction = 0;              // Coulomb's mu
  double friction_speed = 1e-3;     // m/s: mu tanh(v_t / friction_speed)
  Stabilisation stabilisation = Stabilisation::baumgarte;

  bool is_joint() const { return kind == ConstraintKind::joint; }
  /// Of its fast phase; restitution 0 has none.
  Law collision_law() const { return collision.alpha3 != 0 ? collision : law_of(restitution, contact_time); }
  bool is_index_2() const { return stabilisation == Stabilisation::gear_gupta_leimkuhler; }
};

enum class ForceKind { spring, torsion, applied, drag, expression };

/// A force between two bodies, or on body A alone.
template <int D>
struct Force {
  std::string name;
  ForceKind kind = ForceKind::applied;
  int a = kWorld, b = kWorld;
  Point<double, D> at_a = Point<double, D>::Zero(), at_b = Point<double, D>::Zero();  // anchors, in the bodies' axes
  double stiffness = 0, damping = 0, rest = 0;        // spring N/m, N s/m, m; torsion N m/rad, N m s/rad, rad
  Point<double, D> force = Point<double, D>::Zero();  // N, in world axes
  double torque = 0;                                  // N m, planar
  double frequency = 0, phase = 0;                    // Hz, rad: the force times sin(2 pi f t + phase); constant where f = 0
  Expression expression;                              // times the direction in `force`, or `torque`

  /// What it does that no potential accounts for.
  bool has_work() const { return kind == ForceKind::applied || kind == ForceKind::drag || kind == ForceKind::expression || damping != 0; }
};

enum class ImpactLaw { sequential, compliant, hertz, coupled };

template <int D>
struct Scene {
  std::string name;
  std::vector<Body<D>> bodies;
  std::vector<Constraint<D>> constraints;
  std::vector<Force<D>> forces;
  Point<double, D> gravity = Point<double, D>::Zero();  // m/s^2
  ImpactLaw impact_law = ImpactLaw::sequential;
  bool with_audit = true;  // work of every multiplier and force as states
};

}  // namespace tenon::contact
