// A finger pushes a block over a table, lets it slide, and is back where it began: the contact comes and goes.
//
//     m_f v_f' = F - lambda,     m_b v_b' = lambda - mu m_b g tanh(v_b/v_s),     h = x_b - x_f       (both measured at the touching faces)
//
// What lambda is says the mode:  free     lambda = 0
//                                held     h'' + 2 r h' + r^2 h = 0                       phases: approach -> push -> slide, plastic impact
//                                input    lambda = u_2, 0 <= lambda _|_ h >= 0            complementarity; baumgarte with h'' + 2 r h' + r^2 h
//                                law      lambda = k d log(1 + exp(-h/d))                 a soft pad, compliant by nature
#include <memory>

#include "tenon/core/automatic_dae.hpp"
#include "tenon/core/automatic_function.hpp"
#include "tenon/core/weighted_squares.hpp"
#include "tenon/problems/optimal_control/ocp_models.hpp"

namespace tenon {

namespace {

enum State { kFinger, kBlock, kFingerV, kBlockV };
enum Mode { kFree, kHeld, kInput, kLaw };

/// log(1 + exp(z)), which does not overflow.
template <class T>
T soft_plus(const T& z) {
  return z > 0 ? z + log(1 + exp(-z)) : log(1 + exp(z));
}

struct FingerAndBlock {
  static constexpr int kStates = 4, kAlgebraics = 1, kInputs = 2, kOutputs = 3;

  double finger_mass, block_mass, friction, slip_speed, gravity, rate, stiffness, softness;

  template <class T>
  void accelerations(const std::array<T, 4>& x, const T& lambda, const T& force, T& finger, T& block) const {
    finger = (force - lambda) / finger_mass;
    block = lambda / block_mass - friction * gravity * tanh(x[kBlockV] / slip_speed);
  }
  /// h'' + 2 r h' + r^2 h
  template <class T>
  T baumgarte(const std::array<T, 4>& x, const T& finger, const T& block) const {
    return block - finger + 2 * rate * (x[kBlockV] - x[kFingerV]) + rate * rate * (x[kBlock] - x[kFinger]);
  }

  template <class T>
  void equations(const DaeMode& mode, const std::array<T, 4>& x, const std::array<T, 1>& y, const std::array<T, 2>& u,
                 std::array<T, 4>& xdot, std::array<T, 1>& g) const {
    T finger, block;
    accelerations(x, y[0], u[0], finger, block);
    xdot = {x[kFingerV], x[kBlockV], finger, block};
    switch (mode.discrete[0]) {
      case kFree:
        g[0] = y[0];
        break;
      case kHeld:
        g[0] = baumgarte(x, finger, block);
        break;
      case kInput:
        g[0] = y[0] - u[1];
        break;
      default:
        g[0] = y[0] - stiffness * softness * soft_plus(T((x[kFinger] - x[kBlock]) / softness));
    }
  }
  void initial_state(DaeState& s) const { s.mode.discrete = {kFree}; }
  void outputs(const DaeState& s, VectorRef values) const {
    constexpr double kTouching = 1e-3;  // N
    values[0] = s.x[kBlock] - s.x[kFinger];
    values[1] = s.y[0] > kTouching ? 2 : 0;
    values[2] = 0.5 * (finger_mass * s.x[kFingerV] * s.x[kFingerV] + block_mass * s.x[kBlockV] * s.x[kBlockV]);
  }
  std::string name() const { return "push-and-slide"; }
  std::string state_name(int i) const { return std::array{"x1", "x2", "vx1", "vx2"}[static_cast<std::size_t>(i)]; }
  std::string algebraic_name(int) const { return "lambda_finger"; }
  std::string input_name(int i) const { return i == 0 ? "force" : "contact_force"; }
  std::string output_name(int i) const { return std::array{"gap_finger", "mode_finger", "energy"}[static_cast<std::size_t>(i)]; }
};

Scenery draw() {
  constexpr double kSize = 0.06;
  Scenery out;
  out.title = "a finger pushes a block";
  out.bodies.push_back({.name = "table", .shapes = {SceneryShape::half_space({0, 1, 0}, {0, -kSize / 2, 0})}});
  out.bodies.push_back(
      {.name = "finger", .position = {"x1", 0, 0}, .shapes = {SceneryShape::capsule({-1.5 * kSize, 0, 0}, {-kSize / 6, 0, 0}, kSize / 6)}});
  out.bodies.push_back({.name = "block", .position = {"x2", 0, 0}, .shapes = {SceneryShape::box({kSize, kSize, 0}).at({kSize / 2, 0, 0})}});
  out.arrows.push_back({.name = "contact", .at = {.body = "block", .at = {}}, .vector = {"lambda_finger", 0, 0}, .frame = "world"});
  out.plots.push_back({.title = "Forces", .unit = "N", .columns = {"force", "lambda_finger"}});
  return out;
}

/// Where finger and block are to be, at the start and in the end, both at rest. Regularised friction lets the block come to rest without
/// ever stopping: a tenth of its slip speed counts as rest.
struct Task {
  Eigen::Vector4d from, to;
  double rest;

  explicit Task(const OcpModelInput& in)
      : from(-in["clearance"], 0, 0, 0), to(-in["clearance"], in["distance"], 0, 0), rest(0.1 * in["slip_speed"]) {}

  void bind(Box& start, Box& end) const {
    for (int i = 0; i < 4; ++i) start.fix(i, from[i]);
    for (int i = 0; i < 3; ++i) end.fix(i, to[i]);
    end.limit(kBlockV, -rest, rest);
  }
};

void add_single_phase(const OcpModelInput& in, const Task& task, const FingerAndBlock& model, OcpPhase phase, Ocp& ocp) {
  phase.name = "push";
  phase.intervals = in.intervals, phase.duration = in.duration;
  task.bind(phase.start, phase.end);
  if (in.contact == "law") {
    phase.mode.discrete = {kLaw};
    phase.u.fix(1, 0);
  } else {
    phase.mode.discrete = {kInput};
    Complementarity contact;
    contact.first_input = 1;
    contact.epsilon = in["epsilon"];
    contact.gaps = automatic_function<4, 1>([](const auto& x, auto& h) { h[0] = x[kBlock] - x[kFinger]; }, {"finger"});
    if (in.contact == "baumgarte") {
      contact.product = Complementarity::Product::baumgarte;
      contact.epsilon *= in["rate"] * in["rate"];  // w is of the size of r^2 h
      contact.barrier = automatic_function<7, 1>(
          [model](const auto& z, auto& w) {
            using T = std::decay_t<decltype(z[0])>;
            const std::array<T, 4> x{z[0], z[1], z[2], z[3]};
            T finger, block;
            model.accelerations(x, z[4], z[5], finger, block);
            w[0] = model.baumgarte(x, finger, block);
          },
          {"finger"});
    }
    phase.contact = std::make_shared<Complementarity>(contact);
  }
  // There, a push, and back while the block slides on.
  phase.guess = [task, duration = in.duration](double f, VectorRef x, VectorRef y, VectorRef u) {
    const double there = 0.2, apart = 0.6, released = 0.6 * task.to[1];
    const double block = f < there   ? 0
                         : f < apart ? released * (f - there) / (apart - there)
                                     : released + (task.to[1] - released) * (f - apart) / (1 - apart);
    const double finger = f < there   ? task.from[0] * (1 - f / there)
                          : f < apart ? block
                                      : released + (task.to[0] - released) * (f - apart) / (1 - apart);
    x << finger, block, 0, 0;
    x[kBlockV] = f < there ? 0 : task.to[1] / duration;
    y[0] = u[1] = f > there && f < apart ? 1 : 0.01;
  };
  if (in.contact == "law") {
    phase.guess = [guess = phase.guess](double f, VectorRef x, VectorRef y, VectorRef u) { guess(f, x, y, u), u[1] = 0; };
  }
  ocp.phases = {phase};
}

/// Approach, push, slide.
void add_phases(const OcpModelInput& in, const Task& task, const OcpPhase& like, Ocp& ocp) {
  OcpPhase approach = like, push = like, slide = like;
  approach.name = "approach", push.name = "push", slide.name = "slide";
  for (OcpPhase* phase : {&approach, &push, &slide}) {
    phase->intervals = std::max(1, in.intervals / 3);
    phase->duration = in.duration / 3;
    phase->shortest = 0.02 * in.duration, phase->longest = in.duration;
    phase->time_weight = in["time_weight"];
    phase->u.fix(1, 0);
    phase->x.lower[kFinger] = -1e3;
  }
  push.mode.discrete = {kHeld};
  push.y.lower[0] = 0;
  task.bind(approach.start, slide.end);
  approach.end_rows = automatic_function<4, 1>([](const auto& x, auto& h) { h[0] = x[kBlock] - x[kFinger]; }, {"gap"});
  approach.end_rows_box = Box(1);
  approach.end_rows_box.fix(0, 0);
  approach.link = automatic_function<4, 4>([mf = in["finger_mass"], mb = in["block_mass"]](const auto& x, auto& after) {
    after = x;
    after[kFingerV] = after[kBlockV] = (mf * x[kFingerV] + mb * x[kBlockV]) / (mf + mb);
  });
  const auto gap = automatic_function<7, 1>([](const auto& z, auto& h) { h[0] = z[kBlock] - z[kFinger]; }, {"gap"});
  slide.rows = gap;
  slide.rows_box = Box(1);
  slide.rows_box.lower[0] = 0;
  approach.guess = [task](double f, VectorRef x, VectorRef, VectorRef) { x << (1 - f) * task.from[0], 0, 0.1, 0; };
  push.guess = [task](double f, VectorRef x, VectorRef y, VectorRef) {
    x << 0.5 * f * task.to[1], 0.5 * f * task.to[1], 0.2, 0.2, y[0] = 1;
  };
  slide.guess = [task](double f, VectorRef x, VectorRef, VectorRef) {
    x << 0.5 * task.to[1] + f * (task.to[0] - 0.5 * task.to[1]), 0.5 * (1 + f) * task.to[1], 0, 0.2 * (1 - f);
  };
  ocp.phases = {approach, push, slide};
}

OcpScene make(const OcpModelInput& in) {
  require_positive(in, {"finger_mass", "block_mass", "slip_speed", "gravity", "rate", "stiffness", "softness", "largest_force", "epsilon",
                        "clearance", "distance"});
  const FingerAndBlock model{in["finger_mass"], in["block_mass"], in["friction"],  in["slip_speed"],
                             in["gravity"],     in["rate"],       in["stiffness"], in["softness"]};
  OcpScene scene;
  const auto dae = std::make_shared<AutomaticDae<FingerAndBlock>>(model);
  scene.ocp.dae = dae;
  scene.scenery = draw();
  OcpPhase like(*dae);
  like.u.limit(0, -in["largest_force"], in["largest_force"]);
  like.x.lower[kBlockV] = -Task(in).rest;  // nothing pulls it back; said so that iterates stay on this side of the friction
  Vector effort = Vector::Zero(7);
  effort[5] = 1;
  like.cost = std::make_shared<WeightedSquares>(effort, Vector::Zero(7));
  if (in.contact == "phases")
    add_phases(in, Task(in), like, scene.ocp);
  else
    add_single_phase(in, Task(in), model, like, scene.ocp);
  return scene;
}

}  // namespace

OcpModel push_and_slide_model() {
  return {.name = "push-and-slide",
          .parameters = {{"finger_mass", 0.5},
                         {"block_mass", 0.3},
                         {"friction", 0.3},
                         {"slip_speed", 0.05},
                         {"gravity", 9.81},
                         {"rate", 10},
                         {"stiffness", 300},
                         {"softness", 2e-3},
                         {"largest_force", 20},
                         {"epsilon", 1e-5},
                         {"clearance", 0.05},
                         {"distance", 0.3},
                         {"time_weight", 1}},
          .contacts = {"complementarity", "phases", "baumgarte", "law"},
          .duration = 1.5,
          .intervals = 30,
          .make = make};
}

}  // namespace tenon
