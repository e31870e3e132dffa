#include "tenon/apps/impedance.hpp"

#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>

#include "tenon/problems/delta/scene_dae.hpp"
#include "tenon/problems/delta/scene_file.hpp"
#include "tenon/solvers/make_integrator.hpp"

namespace tenon {

namespace {

using namespace delta;

constexpr double kFrom = 0.4, kTo = 60;  // Hz: a little beyond what is reported, for whole windows
constexpr double kLowest = 0.5, kHighest = 50;
constexpr double kSweep = 120;    // s
constexpr double kSample = 1e-3;  // s, the controller's period
constexpr int kPoints = 41;
constexpr double kPeriods = 4;  // in the window of one point

enum class Port { part, wrist };

/// The part is free and held from the start, and a sine that sweeps upward pushes it or the wrist, less than the fingers press.
Scene sweep_scene(const std::string& robot, std::vector<std::string> overrides, Port port, bool loop) {
  for (const char* text : {"gripper.from=0.0195", "gripper.to=0.0195", "object.position=0", "object.stiffness=0", "object.damping=0",
                           "push.amplitude=[0.3,0,0]", "simulation.rtol=1e-6"}) {
    overrides.emplace_back(text);
  }
  if (port == Port::part) overrides.emplace_back("push.on=object");
  overrides.push_back("robot.model=" + ("\"" + robot + "\""));
  if (!loop) overrides.emplace_back("tactile_gain=0");
  Scene scene = load_scene("delta-grasp", overrides);
  scene.push.from = kFrom;
  scene.push.to = kTo;
  scene.push.duration = scene.duration = kSweep;
  return scene;
}

std::vector<double> frequencies() {
  std::vector<double> out;
  for (int k = 0; k < kPoints; ++k) out.push_back(kLowest * std::pow(kHighest / kLowest, static_cast<double>(k) / (kPoints - 1)));
  return out;
}

/// |F/v| at each frequency: the pushed one's speed over a few periods around the time when the sweep is there, fitted by
/// v = a sin phase + b cos phase;  |F/v| = amplitude / |a + jb|.
std::vector<double> sweep(const Scene& scene) {
  const SceneDae dae(scene);
  int rate = 0;
  while (dae.state_name(rate) != "object_rate") ++rate;
  const auto speed_of = [&](const Vector& x) {
    return scene.push.on_object ? x[rate] : (simulation_jacobian(scene.robot, Configuration(Vector9(x.head<9>()))) * x.segment<9>(9))[0];
  };
  std::vector<double> speed;
  IntegratorOptions options;
  options.rtol = scene.rtol;
  options.atol = 1e-2 * scene.rtol;
  DaeState state = initial_state_of(dae);
  const auto integrator = make_integrator("dopri5", dae, options);
  for (long k = 0; k * kSample < kSweep; ++k) {
    const IntegrationResult result = integrator->advance(state, static_cast<double>(k) * kSample);
    if (result.status != IntegrationStatus::reached) throw std::runtime_error("the sweep ends early: " + result.explanation);
    speed.push_back(speed_of(state.x));
  }
  std::vector<double> out;
  const double growth = std::log(kTo / kFrom) / kSweep;
  for (const double frequency : frequencies()) {
    const double middle = std::log(frequency / kFrom) / growth, half = kPeriods / frequency / 2;
    const long first = std::lround((middle - half) / kSample), last = std::lround((middle + half) / kSample);
    Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
    Eigen::Vector2d right = Eigen::Vector2d::Zero();
    for (long k = std::max(first, 0L); k <= last && k < std::ssize(speed); ++k) {
      const double phase = scene.push.phase(static_cast<double>(k) * kSample);
      const Eigen::Vector2d basis(std::sin(phase), std::cos(phase));
      normal += basis * basis.transpose();
      right += speed[static_cast<std::size_t>(k)] * basis;
    }
    out.push_back(scene.push.amplitude[0] / Eigen::Vector2d(normal.ldlt().solve(right)).norm());
  }
  return out;
}

}  // namespace

ImpedanceCurve measure_impedance(const std::string& robot, const std::vector<std::string>& overrides) {
  const auto measure = [&](Port port, bool loop) { return sweep(sweep_scene(robot, overrides, port, loop)); };
  const std::vector<double> off = measure(Port::part, false), on = measure(Port::part, true);
  const std::vector<double> wrist_off = measure(Port::wrist, false), wrist_on = measure(Port::wrist, true), at = frequencies();
  const TactileLoop linear_off(sweep_scene(robot, overrides, Port::part, false)),
      linear_on(sweep_scene(robot, overrides, Port::part, true));
  ImpedanceCurve curve;
  for (std::size_t k = 0; k < at.size(); ++k) {
    curve.points.push_back(
        {at[k], off[k], on[k], std::abs(linear_off.impedance(at[k])), std::abs(linear_on.impedance(at[k])), wrist_off[k], wrist_on[k]});
  }
  Scene grasp = load_scene("delta-grasp", {"robot.model=\"" + robot + "\""});
  curve.margins = TactileLoop(grasp).margins();
  grasp.delay += static_cast<int>(std::lround(2e-3 / grasp.controller.period));
  curve.margins_delayed = TactileLoop(grasp).margins();
  return curve;
}

}  // namespace tenon
