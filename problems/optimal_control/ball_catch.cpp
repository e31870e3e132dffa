// A ball is thrown, bounces off the floor, and a cup catches it and sets it down: flight -> bounce -> catch, every duration free.
//
//     ball:  m v' = lambda - (0, m g)         cup:  v_c' = u (its accelerations)          d = p - p_c
//     free:  lambda = 0                       held: d'' + 2 r d' + r^2 d = 0                                                     (1)
//
//     floor, at y = 0:  v_y+ = -e v_y-,   v_x+ = v_x-                catch, at d = 0:  v+ = v_c (the cup is heavy)               (2)
//
// A cup pushes up and does not pull: lambda_y >= 0. The price of a rough catch is its impulse, squared.
#include <cmath>
#include <memory>
#include <stdexcept>

#include "tenon/core/automatic_dae.hpp"
#include "tenon/core/automatic_function.hpp"
#include "tenon/core/weighted_squares.hpp"
#include "tenon/problems/optimal_control/ocp_models.hpp"

namespace tenon {

namespace {

enum State { kX, kY, kVx, kVy, kCupX, kCupY, kCupVx, kCupVy };

struct BallAndCup {
  static constexpr int kStates = 8, kAlgebraics = 2, kInputs = 2, kOutputs = 3;

  double mass, gravity, rate;

  template <class T>
  void equations(const DaeMode& mode, const std::array<T, 8>& x, const std::array<T, 2>& y, const std::array<T, 2>& u,
                 std::array<T, 8>& xdot, std::array<T, 2>& g) const {
    const std::array<T, 2> a{y[0] / mass, y[1] / mass - gravity};
    xdot = {x[kVx], x[kVy], a[0], a[1], x[kCupVx], x[kCupVy], u[0], u[1]};
    for (std::size_t i = 0; i < 2; ++i) {
      if (mode.discrete[0] == 0)
        g[i] = y[i];
      else
        g[i] = a[i] - u[i] + 2 * rate * (x[kVx + i] - x[kCupVx + i]) + rate * rate * (x[kX + i] - x[kCupX + i]);
    }
  }
  void initial_state(DaeState& s) const { s.mode.discrete = {0}; }
  void outputs(const DaeState& s, VectorRef values) const {
    values[0] = s.x[kY];
    values[1] = s.mode.discrete[0] == 0 ? 0 : 2;
    values[2] = mass * (0.5 * s.x.segment(kVx, 2).squaredNorm() + gravity * s.x[kY]);
  }
  std::string name() const { return "bouncing-ball-catch"; }
  std::string state_name(int i) const {
    return std::array{"x1", "y1", "vx1", "vy1", "x2", "y2", "vx2", "vy2"}[static_cast<std::size_t>(i)];
  }
  std::string algebraic_name(int i) const { return i == 0 ? "lambda_cup_x" : "lambda_cup_y"; }
  std::string input_name(int i) const { return i == 0 ? "cup_ax" : "cup_ay"; }
  std::string output_name(int i) const { return std::array{"gap_floor", "mode_cup", "energy"}[static_cast<std::size_t>(i)]; }
};

Scenery draw() {
  constexpr double kRadius = 0.03;
  Scenery out;
  out.title = "a ball bounces and is caught";
  out.bodies.push_back({.name = "floor", .shapes = {SceneryShape::half_space({0, 1, 0}, {0, -kRadius, 0})}});
  out.bodies.push_back(
      {.name = "cup",
       .position = {"x2", "y2", 0},
       .shapes = {SceneryShape::line(
                      {{-2 * kRadius, kRadius, 0}, {-kRadius, -kRadius, 0}, {kRadius, -kRadius, 0}, {2 * kRadius, kRadius, 0}})
                      .colored("link")},
       .trail = true});
  out.bodies.push_back({.name = "ball", .position = {"x1", "y1", 0}, .shapes = {SceneryShape::disc(kRadius)}, .trail = true});
  out.arrows.push_back(
      {.name = "cup's force", .at = {.body = "ball", .at = {}}, .vector = {"lambda_cup_x", "lambda_cup_y", 0}, .frame = "world"});
  out.plots.push_back({.title = "Cup's acceleration", .unit = "m/s^2", .columns = {"cup_ax", "cup_ay"}});
  return out;
}

OcpScene make(const OcpModelInput& in) {
  require_positive(in, {"mass", "height", "rate", "largest_acceleration", "softness"});
  const double e = in["restitution"];
  if (!(e >= 0 && e <= 1)) throw std::invalid_argument("restitution " + std::to_string(e) + " (expected 0 to 1)");
  OcpScene scene;
  const auto dae = std::make_shared<AutomaticDae<BallAndCup>>(BallAndCup{in["mass"], in["gravity"], in["rate"]});
  scene.ocp.dae = dae;
  scene.scenery = draw();

  OcpPhase flight(*dae);
  flight.intervals = in.intervals;
  flight.shortest = 0.02, flight.longest = in.duration;
  for (int i = 0; i < 2; ++i) flight.u.limit(i, -in["largest_acceleration"], in["largest_acceleration"]);
  flight.x.lower[kCupY] = in["least_height"];
  Vector effort = Vector::Zero(12);
  effort.tail(2).setConstant(1);
  flight.cost = std::make_shared<WeightedSquares>(effort, Vector::Zero(12));
  OcpPhase bounce = flight, caught = flight;

  const double fall = std::sqrt(2 * in["height"] / in["gravity"]), speed = in["speed"], cup = in["cup"];
  flight.name = "flight";
  const double start[] = {0, in["height"], speed, 0, cup, in["least_height"], 0, 0};
  for (int i = 0; i < 8; ++i) flight.start.fix(i, start[i]);
  flight.duration = fall;
  flight.end.fix(kY, 0);
  flight.link = automatic_function<8, 8>([e](const auto& x, auto& after) {
    after = x;
    after[kVy] = -e * x[kVy];
  });
  flight.guess = [=, gravity = in["gravity"], height = in["height"], low = in["least_height"]](double f, VectorRef x, VectorRef,
                                                                                               VectorRef) {
    const double t = f * fall;
    x << speed * t, height - 0.5 * gravity * t * t, speed, -gravity * t, cup, low, 0, 0;
  };

  const double rise = e * fall;  // until the ball is highest
  bounce.name = "bounce";
  bounce.duration = rise;
  bounce.end_rows = automatic_function<8, 2>([](const auto& x, auto& d) { d = {x[kX] - x[kCupX], x[kY] - x[kCupY]}; }, {"x", "y"});
  bounce.end_rows_box = Box(2);
  bounce.end_rows_box.fix(0, 0), bounce.end_rows_box.fix(1, 0);
  bounce.end_cost = automatic_function<8, 1>([softness = in["softness"], mass = in["mass"]](const auto& x, auto& f) {
    f[0] = square(mass / softness) * (square(x[kVx] - x[kCupVx]) + square(x[kVy] - x[kCupVy]));
  });
  bounce.link = automatic_function<8, 8>([](const auto& x, auto& after) {
    after = x;
    after[kVx] = x[kCupVx], after[kVy] = x[kCupVy];
  });
  bounce.guess = [=, gravity = in["gravity"], low = in["least_height"]](double f, VectorRef x, VectorRef, VectorRef) {
    const double t = f * rise, meets = speed * (fall + rise), top = 0.5 * gravity * rise * rise;
    x << speed * (fall + t), gravity * t * (rise - 0.5 * t), speed, gravity * (rise - t), cup + f * (meets - cup), low + f * (top - low), 0,
        0;
  };

  caught.name = "catch";
  caught.mode.discrete = {1};
  caught.duration = 0.5;
  caught.time_weight = in["time_weight"];
  caught.y.lower[1] = 0;
  const double goal[] = {in["goal_x"], in["goal_y"]};
  for (int i = 0; i < 2; ++i) {
    caught.end.fix(kCupX + i, goal[i]);
    caught.end.fix(kCupVx + i, 0);
  }
  caught.guess = [=, mass = in["mass"], gravity = in["gravity"]](double f, VectorRef x, VectorRef y, VectorRef) {
    const double meets = speed * (fall + rise), top = 0.5 * gravity * rise * rise;
    const double px = meets + f * (goal[0] - meets), py = top + f * (goal[1] - top);
    x << px, py, 0, 0, px, py, 0, 0;
    y << 0, mass * gravity;
  };
  scene.ocp.phases = {flight, bounce, caught};
  return scene;
}

}  // namespace

OcpModel ball_catch_model() {
  return {.name = "bouncing-ball-catch",
          .parameters = {{"mass", 0.05},
                         {"gravity", 9.81},
                         {"height", 1},
                         {"speed", 0.8},
                         {"restitution", 0.8},
                         {"cup", 1},
                         {"least_height", 0.1},
                         {"goal_x", 0.6},
                         {"goal_y", 0.3},
                         {"largest_acceleration", 15},
                         {"softness", 0.02},
                         {"time_weight", 2},
                         {"rate", 10}},
          .contacts = {},
          .duration = 2,
          .intervals = 10,
          .make = make};
}

}  // namespace tenon
