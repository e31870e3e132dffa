// Position constraints two ways: Baumgarte's terms let a chain's links drift by what integration errs, the stabilised index 2 form of Gear,
// Gupta and Leimkuhler holds them; both move the same.
#include <gtest/gtest.h>

#include <cmath>

#include "tenon/core/input_error.hpp"
#include "tenon/tests/scene_run.hpp"

namespace tenon {
namespace {

const std::string kStabilised = "simulation.stabilisation=\"gear-gupta-leimkuhler\"";

/// Five links let go while they point to the right.
const std::string kChain = R"(
[simulation]
gravity = [0.0, -9.81]
duration = 5.0
rtol = 1e-8
[[body]]
count = 5
name = "bead{i}"
kind = "point"
mass = 0.1
position = ["0.2 * i", "0"]
[[joint]]
name = "hook"
type = "distance"
between = ["bead1", "world"]
to = [0.0, 0.0]
[[joint]]
count = 4
name = "link{i}"
type = "distance"
between = ["bead{i+1}", "bead{i}"]
)";

/// Two rods in space, hung by ball joints and thrown sideways, so that they turn about all axes.
const std::string kRods = R"(
[simulation]
space = "spatial"
gravity = [0.0, 0.0, -9.81]
duration = 3.0
rtol = 1e-9
[[body]]
name = "upper"
mass = 1.0
inertia = [0.02, 0.002, 0.02]
position = [0.0, 0.25, 0.0]
velocity = [0.5, 0.0, 0.0]
omega = [0.0, 0.0, -2.0]
[[body]]
name = "lower"
mass = 0.5
inertia = [0.01, 0.001, 0.01]
position = [0.0, 0.75, 0.0]
velocity = [1.0, 0.0, 0.0]
[[joint]]
name = "hook"
type = "ball"
between = ["upper", "world"]
at = [0.0, 0.0, 0.0]
[[joint]]
name = "elbow"
type = "ball"
between = ["lower", "upper"]
at = [0.0, 0.5, 0.0]
)";

SceneRun run_text(const std::string& text, const std::vector<std::string>& overrides, const std::string& integrator) {
  return run_scene(contact::parse_scene(text, "scene.toml", overrides), integrator);
}

/// The widest that any constraint stood open in the record, m.
template <int D>
double drift(const SceneRun& run) {
  const auto& dae = static_cast<const contact::ContactDae<D>&>(*run.dae);
  Dae::Workspace workspace = dae.make_workspace();
  double widest = 0;
  for (const DaeState& state : run.states) {
    for (int i = 0; i < dae.num_constraints(); ++i) widest = std::max(widest, std::abs(dae.gap(i, state.t, state.x, workspace).h));
  }
  return widest;
}

TEST(Stabilisation, HoldsAChainThatBaumgarteLetsDrift) {
  const double swing = 0.1 * 9.81 * (0.2 + 0.4 + 0.6 + 0.8 + 1.0);
  const SceneRun drifts = run_text(kChain, {}, "dop853"), holds = run_text(kChain, {kStabilised}, "dop853");
  EXPECT_GT(drift<2>(drifts), 1e-9) << "nothing to hold";
  EXPECT_LT(drift<2>(holds), 1e-14);
  EXPECT_LT(holds.largest("energy_error"), 1e-8 * swing);
  // BDF solves h = 0 in every step; its record interpolates between them
  const SceneRun bdf = run_text(kChain, {kStabilised}, "ida");
  EXPECT_LT(drift<2>(bdf), 1e-8);
  EXPECT_LT(drift<2>(bdf), 0.2 * drift<2>(run_text(kChain, {}, "ida")));
  EXPECT_LT(bdf.largest("energy_error"), 1e-6 * swing);
}

TEST(Stabilisation, TurnsRodsInSpaceAsBaumgarteDoes) {
  const SceneRun reference = run_scene(contact::parse_scene(kRods, "scene.toml"), "dop853", 1e-12);
  for (const char* integrator : {"dop853", "ida"}) {
    const SceneRun run = run_text(kRods, {kStabilised}, integrator);
    EXPECT_LT(drift<3>(run), 1e-9) << integrator;
    for (const char* name : {"x2", "y2", "z2"})
      EXPECT_NEAR(run.last(name), reference.last(name), std::string(integrator) == "ida" ? 1e-5 : 1e-7) << integrator << " " << name;
    // the multipliers of the closed form, not of BDF's last Newton step
    EXPECT_NEAR(run.last("lambda_hook_z"), reference.last("lambda_hook_z"), 1e-4) << integrator;
    EXPECT_EQ(run.largest("mu_hook_z"), 0) << integrator << ": no correction is left on the manifold";
  }
}

TEST(Stabilisation, GoesOnThroughCollisionsAndBesideOtherJoints) {
  for (const auto& [scene, exchanged] : {std::pair("cradle", 1.3), std::pair("circuit-breaker", 0.1), std::pair("car", 100.0)}) {
    const SceneRun run = run_scene(scene, {kStabilised});
    EXPECT_LT(run.largest("energy_error"), 1e-6 * exchanged) << scene << ", J";
    EXPECT_GE(run.events_to(1).size(), 3u) << scene;
  }
  const SceneRun mixed = run_text(kChain + "pole = 20.0\n", {kStabilised}, "dop853");
  EXPECT_GT(drift<2>(mixed), 1e-14) << "these links keep Baumgarte's terms";
  EXPECT_LT(mixed.largest("energy_error"), 1e-6);
}

TEST(Stabilisation, JacobiansOfIndexTwoAgreeWithDifferences) {
  for (const std::string& text : {kChain, kRods}) check_jacobian(contact::parse_scene(text, "scene.toml", {kStabilised}), 1e-6);
  check_jacobian(contact::load_scene("circuit-breaker", {kStabilised}), 1e-6);
}

TEST(Stabilisation, TellsWhatItDoesNotKnow) {
  const auto complaint = [](const std::string& text) -> std::string {
    try {
      contact::parse_scene(text, "scene.toml");
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(complaint(kChain + "stabilisation = \"gear\"\n").find("scene.toml:22:17: unknown stabilisation 'gear'"), std::string::npos)
      << complaint(kChain + "stabilisation = \"gear\"\n");
  EXPECT_NE(complaint(kChain + "pole = 2.0\nstabilisation = \"gear-gupta-leimkuhler\"\n").find("has no pole"), std::string::npos);
  EXPECT_NE(complaint(kChain + "[[joint]]\nname = \"r\"\ntype = \"rope\"\nbetween = [\"bead1\", \"world\"]\nto = [0.0, "
                               "1.0]\nstabilisation = \"baumgarte\"\n")
                .find("a rope is a contact"),
            std::string::npos);
}

}  // namespace
}  // namespace tenon
