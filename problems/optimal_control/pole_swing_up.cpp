// cart-pole and pendulum as Ocps: a pole on a cart, swung up by a bounded force.
//
//     D(theta) = M + m sin^2,    a = (u + m l omega^2 sin + m g cos sin) / D,    alpha = -(a cos + g sin) / l              swing_up.md (1)
#include <cmath>
#include <memory>

#include "tenon/core/automatic_dae.hpp"
#include "tenon/core/weighted_squares.hpp"
#include "tenon/problems/optimal_control/ocp_models.hpp"

namespace tenon {

namespace {

constexpr double kPi = 3.14159265358979323846;

struct Pole {
  static constexpr int kStates = 4, kAlgebraics = 0, kInputs = 1, kOutputs = 1;

  double cart_mass, pole_mass, length, gravity;
  double orientation;  // 1: the angle is counted from hanging; -1: from upright

  template <class T>
  void equations(const DaeMode&, const std::array<T, 4>& x, const std::array<T, 0>&, const std::array<T, 1>& u, std::array<T, 4>& xdot,
                 std::array<T, 0>&) const {
    const T sine = orientation * sin(x[1]), cosine = orientation * cos(x[1]);
    const T a = (u[0] + pole_mass * sine * (length * square(x[3]) + gravity * cosine)) / (cart_mass + pole_mass * square(sine));
    xdot = {x[2], x[3], a, -(cosine * a + gravity * sine) / length};
  }

  // 1/2 (M + m) v^2 + m l v omega cos + 1/2 m l^2 omega^2 - m g l cos
  void outputs(const DaeState& s, VectorRef values) const {
    const double v = s.x[2], omega = s.x[3], cosine = orientation * std::cos(s.x[1]);
    values[0] =
        0.5 * (cart_mass + pole_mass) * v * v + pole_mass * length * (v * omega * cosine + 0.5 * length * omega * omega - gravity * cosine);
  }
  std::string name() const { return "pole"; }
  std::string state_name(int i) const {
    return std::array{"position", "angle", "velocity", "angular_velocity"}[static_cast<std::size_t>(i)];
  }
  std::string input_name(int) const { return "force"; }
  std::string output_name(int) const { return "energy"; }
};

Scenery draw(const Pole& pole) {
  Scenery out;
  out.title = "a pole on a cart";
  const double length = pole.length, size = 0.25 * length;
  out.bodies.push_back({.name = "rail", .shapes = {SceneryShape::line({{-4 * length, 0, 0}, {4 * length, 0, 0}}).colored("ground")}});
  out.bodies.push_back({.name = "cart", .position = {"position", 0, 0}, .shapes = {SceneryShape::box({1.6 * size, size, 0})}});
  out.bodies.push_back({.name = "pole",
                        .parent = "cart",
                        .angle = "angle",
                        .shapes = {SceneryShape::line({{0, 0, 0}, {0, -pole.orientation * length, 0}}).colored("link"),
                                   SceneryShape::disc(0.3 * size).at({0, -pole.orientation * length, 0})},
                        .trail = true});
  out.arrows.push_back({.name = "force", .at = {.body = "cart", .at = {}}, .vector = {"force", 0, 0}, .frame = "world"});
  out.plots.push_back({.title = "Force", .unit = "N", .columns = {"force"}});
  return out;
}

void begin(const OcpModelInput& in, double orientation, OcpScene& scene) {
  require_positive(in, {"cart_mass", "pole_mass", "length"});
  const Pole pole{in["cart_mass"], in["pole_mass"], in["length"], in["gravity"], orientation};
  const auto dae = std::make_shared<AutomaticDae<Pole>>(pole);
  OcpPhase phase(*dae);
  phase.name = "swing-up";
  phase.intervals = in.intervals, phase.duration = in.duration;
  phase.u.limit(0, -in["largest_force"], in["largest_force"]);
  scene.ocp.dae = dae;
  scene.ocp.phases = {phase};
  scene.scenery = draw(pole);
}

/// integral u^2 dt / (T/N): the sum of squares over the intervals.
OcpScene make_cart_pole(const OcpModelInput& in) {
  OcpScene scene;
  begin(in, 1, scene);
  OcpPhase& phase = scene.ocp.phases.front();
  phase.x.limit(0, in["least_position"], in["largest_position"]);
  for (int i = 0; i < 4; ++i) phase.start.fix(i, 0);
  const Eigen::Vector4d goal(in["goal"], kPi, 0, 0);
  for (int i = 0; i < 4; ++i) phase.end.fix(i, goal[i]);
  Vector weights = Vector::Zero(5);
  weights[4] = 2 * in.intervals / in.duration;
  phase.cost = std::make_shared<WeightedSquares>(weights, Vector::Zero(5));
  return scene;
}

OcpScene make_pendulum(const OcpModelInput& in) {
  OcpScene scene;
  begin(in, -1, scene);
  OcpPhase& phase = scene.ocp.phases.front();
  const Eigen::Vector4d initial(0, kPi, 0, 0);
  for (int i = 0; i < 4; ++i) phase.start.fix(i, initial[i]);
  Vector weights(5);
  weights << in["weight"], in["weight"], in["rate_weight"], in["rate_weight"], in["force_weight"];
  phase.cost = std::make_shared<WeightedSquares>(weights, Vector::Zero(5));
  phase.end_cost = std::make_shared<WeightedSquares>(weights.head(4), Vector::Zero(4));
  phase.guess = [initial](double, VectorRef x, VectorRef, VectorRef) { x = initial; };
  return scene;
}

}  // namespace

OcpModel cart_pole_model() {
  return {.name = "cart-pole",
          .parameters = {{"cart_mass", 5},
                         {"pole_mass", 0.5},
                         {"length", 0.5},
                         {"gravity", 9.806},
                         {"largest_force", 20},
                         {"least_position", 0},
                         {"largest_position", 2},
                         {"goal", 1}},
          .contacts = {},
          .duration = 5,
          .intervals = 100,
          .make = make_cart_pole};
}

OcpModel pendulum_model() {
  return {.name = "pendulum",
          .parameters = {{"cart_mass", 1},
                         {"pole_mass", 0.1},
                         {"length", 0.8},
                         {"gravity", 9.81},
                         {"largest_force", 80},
                         {"weight", 2e3},
                         {"rate_weight", 2e-2},
                         {"force_weight", 2e-2}},
          .contacts = {},
          .duration = 1,
          .intervals = 20,
          .make = make_pendulum};
}

}  // namespace tenon
