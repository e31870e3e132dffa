// A pendulum in redundant coordinates, made index 1 by Baumgarte's rule: a bob at (x, y) on a rod, driven by a torque at its pivot.
//
//     m v' = -lambda p + (u/l^2) (-y, x) - (0, m g),     h = (p.p - l^2)/2,     h'' + 2 r h' + r^2 h = 0                           (1)
//
// h' = p.v, h'' = v.v + p.v': linear in lambda with the factor -p.p/m, so that F can be solved for (xdot, lambda) wherever p is not 0.
// The rod pulls with lambda l. [J. Baumgarte, Comp. Meth. Appl. Mech. Eng. 1 (1972) 1]
#include <cmath>
#include <memory>

#include "tenon/core/automatic_dae.hpp"
#include "tenon/core/weighted_squares.hpp"
#include "tenon/problems/optimal_control/ocp_models.hpp"

namespace tenon {

namespace {

constexpr double kPi = 3.14159265358979323846;

struct Bob {
  static constexpr int kStates = 4, kAlgebraics = 1, kInputs = 1, kOutputs = 2;

  double mass, length, gravity, rate;

  template <class T>
  void equations(const DaeMode&, const std::array<T, 4>& x, const std::array<T, 1>& y, const std::array<T, 1>& u, std::array<T, 4>& xdot,
                 std::array<T, 1>& g) const {
    const T push = u[0] / (mass * length * length), pull = y[0] / mass;
    const T ax = -pull * x[0] - push * x[1], ay = push * x[0] - pull * x[1] - gravity;
    xdot = {x[2], x[3], ax, ay};
    const T h = 0.5 * (square(x[0]) + square(x[1]) - length * length), h_rate = x[0] * x[2] + x[1] * x[3];
    g[0] = square(x[2]) + square(x[3]) + x[0] * ax + x[1] * ay + 2 * rate * h_rate + rate * rate * h;
  }
  void initial_state(DaeState& s) const {
    s.x << 0, -length, 0, 0;
    s.y[0] = mass * gravity / length;
  }
  void outputs(const DaeState& s, VectorRef values) const {
    values[0] = 0.5 * (s.x.head(2).squaredNorm() - length * length);
    values[1] = mass * (0.5 * s.x.tail(2).squaredNorm() + gravity * s.x[1]);
  }
  std::string name() const { return "pendulum-cartesian"; }
  std::string state_name(int i) const { return std::array{"x1", "y1", "vx1", "vy1"}[static_cast<std::size_t>(i)]; }
  std::string algebraic_name(int) const { return "lambda_rod"; }
  std::string input_name(int) const { return "torque"; }
  std::string output_name(int i) const { return i == 0 ? "gap_rod" : "energy"; }
};

Scenery draw(const Bob& bob) {
  Scenery out;
  out.title = "a pendulum in Cartesian coordinates";
  out.bodies.push_back({.name = "pivot", .shapes = {SceneryShape::disc(0.03 * bob.length).colored("ground")}});
  out.bodies.push_back({.name = "bob", .position = {"x1", "y1", 0}, .shapes = {SceneryShape::disc(0.08 * bob.length)}, .trail = true});
  out.links.push_back({.from = {.body = "pivot", .at = {}}, .to = {.body = "bob", .at = {}}});
  out.arrows.push_back({.name = "weight and rod",
                        .kind = SceneryArrow::Kind::velocity,
                        .at = {.body = "bob", .at = {}},
                        .vector = {"vx1", "vy1", 0},
                        .frame = "world"});
  return out;
}

/// From hanging to upright, at rest; least torque.
OcpScene make(const OcpModelInput& in) {
  require_positive(in, {"mass", "length", "largest_torque", "rate"});
  const Bob bob{in["mass"], in["length"], in["gravity"], in["rate"]};
  OcpScene scene;
  const auto dae = std::make_shared<AutomaticDae<Bob>>(bob);
  OcpPhase phase(*dae);
  phase.name = "swing-up";
  phase.intervals = in.intervals, phase.duration = in.duration;
  phase.u.limit(0, -in["largest_torque"], in["largest_torque"]);
  const Eigen::Vector4d from(0, -bob.length, 0, 0), to(0, bob.length, 0, 0);
  // The rod keeps its length by itself: of the end, the place along it is not asked for twice.
  for (int i = 0; i < 4; ++i) phase.start.fix(i, from[i]);
  phase.end.fix(0, to[0]), phase.end.fix(2, to[2]);
  phase.end.limit(1, 0.5 * bob.length, 1.5 * bob.length);
  Vector weights = Vector::Zero(6);
  weights[5] = 1;
  phase.cost = std::make_shared<WeightedSquares>(weights, Vector::Zero(6));
  phase.guess = [bob](double fraction, VectorRef x, VectorRef y, VectorRef) {
    const double angle = kPi * fraction, omega = kPi;
    x << bob.length * std::sin(angle), -bob.length * std::cos(angle), omega * bob.length * std::cos(angle),
        omega * bob.length * std::sin(angle);
    y[0] = bob.mass * bob.gravity / bob.length;
  };
  scene.ocp.dae = dae;
  scene.ocp.phases = {phase};
  scene.scenery = draw(bob);
  return scene;
}

}  // namespace

OcpModel cartesian_pendulum_model() {
  return {.name = "pendulum-cartesian",
          .parameters = {{"mass", 1}, {"length", 1}, {"gravity", 9.81}, {"largest_torque", 5}, {"rate", 5}},
          .contacts = {},
          .duration = 3,
          .intervals = 40,
          .make = make};
}

}  // namespace tenon
