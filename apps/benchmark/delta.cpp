// The delta robot: one control tick, one right-hand side of its DAE, a tick of it as a plant, and its loop at 1 kHz in the simulator.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tenon/apps/benchmark/benchmark.hpp"
#include "tenon/apps/statistics.hpp"
#include "tenon/problems/delta/controller.hpp"
#include "tenon/problems/delta/plant.hpp"
#include "tenon/problems/delta/robot_file.hpp"
#include "tenon/problems/delta/scene_dae.hpp"
#include "tenon/problems/delta/scene_file.hpp"
#include "tenon/solvers/make_integrator.hpp"

namespace tenon {

namespace {

using namespace delta;

constexpr int kRuns = 20000, kPoses = 200;

/// Poses and rates on the circle of delta-circle.
std::vector<std::pair<Configuration, Vector9>> circle(const Robot& robot) {
  std::vector<std::pair<Configuration, Vector9>> out;
  for (int k = 0; k < kPoses; ++k) {
    const double angle = 2 * std::numbers::pi * k / kPoses;
    const Vector3 wrist(0.06 * std::cos(angle), 0.06 * std::sin(angle), 0.4);
    const Configuration at(inverse_kinematics(robot, wrist).q);
    const Motion motion(robot, at);
    out.emplace_back(at, motion.rates(motion.motors(std::numbers::pi * Vector3(-wrist[1], wrist[0], 0))));
  }
  return out;
}

/// From measured angles and rates to torques: forward kinematics, Jacobians, reduced inertia, gravity, the exact law, the integrator.
void run_tick(BenchmarkRun& out) {
  const Robot robot = load_robot("delta");
  Controller controller(robot, {});
  std::vector<Measurement> measurements;
  for (const auto& [at, v] : circle(robot)) {
    const Vector9 q = angles(at);
    measurements.push_back({{q[0], q[3], q[6]}, {v[0], v[3], v[6]}});
  }
  double sum = 0;
  controller.set_reference({{0, 0, 0.4}, {0, 0, 0}, {0, 0, 0}});
  time_each(kRuns, out, [&](int k) { sum += controller.tick(measurements[static_cast<std::size_t>(k % kPoses)]).torque[0]; });
  if (!std::isfinite(sum)) out.notes.emplace_back("not finite");
}

/// From q and v to v' and the closure forces.
void run_dae(BenchmarkRun& out) {
  const Robot robot = load_robot("delta");
  const ArmConstants constants(robot);
  std::vector<std::pair<Vector9, Vector9>> states;
  for (const auto& [at, v] : circle(robot)) states.emplace_back(angles(at), v);
  double sum = 0;
  time_each(kRuns, out, [&](int k) {
    const auto& [q, v] = states[static_cast<std::size_t>(k % kPoses)];
    const Acceleration a = acceleration(robot, constants, Configuration(q), v, {0.1, 0.2, 0.3}, Vector3::Zero());
    sum += a.v_rate[0] + a.lambda[5];
  });
  if (!std::isfinite(sum)) out.notes.emplace_back("not finite");
}

/// A millisecond of robot and gimbals under held torques, the tool on a stiff wall.
void run_plant(BenchmarkRun& out) {
  Plant plant(load_robot("delta"), {.tool = {0, 0, 0.04}});
  plant.place({0, 0, 0.4}, {0, 0, 0});
  const auto wall = [](const ToolMotion& tool) { return Wrench{{0, 0, -2e5 * std::max(0.0, tool.position[2] - 0.44)}, {0, 0, 0}}; };
  time_each(kRuns / 10, out, [&](int) { plant.step({-0.3, -0.3, -0.3}, {0, 0, 0}, wall); });
  out.notes.push_back(fmt::format("{:.0f} times real time, micro-steps of {:g} us", plant.options().period / median(out.seconds),
                                  1e6 * plant.options().micro_step));
}

/// delta-joystick, which is sampled at 1 kHz, ten ticks at a time.
void run_loop(const std::string& integrator, BenchmarkRun& out) {
  constexpr double kPiece = 0.01;  // s
  const SceneDae dae(load_scene("delta-joystick"));
  IntegratorOptions options;
  options.rtol = 1e-6;
  options.atol = 1e-8;
  const auto flow = make_integrator(integrator, dae, options);
  DaeState state = initial_state_of(dae);
  time_each(static_cast<int>(dae.scene().duration / kPiece), out, [&](int k) { flow->advance(state, (k + 1) * kPiece); });
  out.notes.push_back(fmt::format("{:.0f} times real time, rtol {:g}", kPiece / median(out.seconds), options.rtol));
}

}  // namespace

void add_delta(std::vector<Benchmark>& rows) {
  rows.push_back({"delta/tick", &run_tick});
  rows.push_back({"delta/dae", &run_dae});
  rows.push_back({"delta/plant", &run_plant});
  rows.push_back({"delta/loop", [](BenchmarkRun& out) { run_loop("dopri5", out); }});
  rows.push_back({"delta/loop/dop853", [](BenchmarkRun& out) { run_loop("dop853", out); }});
  const std::vector<IntegratorDescription> integrators = list_integrators();
  if (std::ranges::any_of(integrators, [](const auto& i) { return i.name == "ida" && i.available; })) {
    rows.push_back({"delta/loop/ida", [](BenchmarkRun& out) { run_loop("ida", out); }});
  }
}

}  // namespace tenon
