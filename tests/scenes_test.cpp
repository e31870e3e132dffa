// Every built-in scene over its own time: the energy audit closes, nothing goes through anything, and something happens.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "tenon/tests/scene_run.hpp"

namespace tenon {
namespace {

/// Kinetic energies of the rows, J.
template <int D>
Vector kinetic_energies(const contact::Scene<D>& scene, const SceneRun& run) {
  Vector energies = Vector::Zero(static_cast<int>(run.states.size()));
  for (int k = 0; k < energies.size(); ++k) {
    int at = 0;  // of the body in x: its positions, then its velocities
    for (const contact::Body<D>& body : scene.bodies) {
      for (int l = 0; l < body.freedoms; ++l) {
        const double v = run.states[static_cast<std::size_t>(k)].x[at + body.num_positions() + l];
        energies[k] += 0.5 * (l < D ? body.mass : body.inertia[l - D]) * v * v;
      }
      at += body.num_positions() + body.freedoms;
    }
  }
  return energies;
}

/// What a run exchanges is the span of its kinetic energy, J.
double exchanged_energy(const contact::SceneFile& file, const SceneRun& run) {
  const Vector energies = std::visit([&](const auto& scene) { return kinetic_energies(scene, run); }, file.scene);
  return energies.maxCoeff() - energies.minCoeff();
}

// The least numbers stand a little below what each scene does, so that one in which nothing happens fails.
TEST(Scenes, HappenWithoutPenetrationAndCloseTheirEnergyAudit) {
  struct Expected {
    std::size_t collisions;
    double exchanged;     // J
    double depth = 1e-8;  // m, at most: a contact of one law goes in as deep as its law has it
  };
  const std::map<std::string, Expected> table{{"ball-and-cup", {20, 0.3}},
                                              {"ball-maze", {40, 0.007}},
                                              {"bouncing-ball", {3, 9.8, 0.065}},
                                              {"bouncing-ball-restitution", {50, 9.8}},
                                              {"box-in-corner", {2, 0.99, 0.011}},
                                              {"box-stack", {15, 0.8}},
                                              {"cable-sway", {100, 0.3}},
                                              {"car", {60, 500}},
                                              {"chain-fountain", {40, 0.1}},
                                              {"circuit-breaker", {5, 0.2}},
                                              {"cradle", {40, 1.3}},
                                              {"falling-body", {10, 2.9}},
                                              {"impact-oscillator", {40, 0.7}},
                                              {"paper-clip", {5, 0.1}},
                                              {"peg-and-hole", {100, 0.06}},
                                              {"rocking-block", {20, 0.7}},
                                              {"rope-sway", {0, 2.5e-8}}};
  for (const std::string& name : contact::builtin_scenes()) {
    ASSERT_TRUE(table.contains(name)) << name << " is not in the table";
    const Expected& expected = table.at(name);
    const contact::SceneFile file = contact::load_scene(name);
    const SceneRun run = run_scene(file);
    const double exchanged = exchanged_energy(file, run);
    EXPECT_GE(run.events_to(contact::kCollision).size(), expected.collisions) << name;
    EXPECT_GE(exchanged, expected.exchanged) << name;
    EXPECT_LT(run.largest("energy_error"), 1e-6 * exchanged) << name;
    for (const std::string& column : run.names) {
      const bool is_gap = column.starts_with("gap_"), is_force = column.starts_with("lambda_") && run.is_contact(column);
      if (!is_gap && !is_force) continue;
      EXPECT_GE(run.smallest(column), is_gap ? -expected.depth : -1e-6) << name << " " << column;
    }
  }
}

// Boxes that rebound rock on one another while the lowest rebounds from the floor: many guards fall and rise within one step.
TEST(BoxStack, ComesToRestFromItsRebounds) {
  const SceneRun run = run_scene("box-stack", {"restitution=0.3"});
  EXPECT_GE(run.events_to(contact::kCollision).size(), 100u);
  EXPECT_LT(run.largest("energy_error"), 1e-9);
  for (const std::string& column : run.names) {
    if (column.starts_with("gap_")) {
      EXPECT_GE(run.smallest(column), -1.1e-9) << column << ": what touches is no deeper than it touches";
    }
  }
  for (int i = 1; i <= 5; ++i) {
    const std::string box = std::to_string(i);
    EXPECT_NEAR(run.last("y" + box), 0.2 * (i - 0.5), 1e-8) << "box " << i;
    EXPECT_NEAR(run.last("vy" + box), 0, 1e-9) << "box " << i;
    EXPECT_NEAR(run.last("omega" + box), 0, 1e-9) << "box " << i;
  }
  EXPECT_NEAR(run.last("lambda_floor_1") + run.last("lambda_floor_2"), 5 * 9.81, 1e-6);
}

// The wheels stay on the flat road; the body above them heaves on both springs, released at rest from z = heave:
//     m z'' + 2 d z' + 2 k z = 0,    omega_0^2 = 2k/m = omega^2 + c^2,  c = d/m,    z = heave e^{-ct} (cos omega t + c/omega sin omega t)
TEST(Car, HeavesAtTheFrequencyOfItsSuspension) {
  const double heave = 0.005, mass = 400, stiffness = 20e3, c = 1500 / mass, omega = std::sqrt(2 * stiffness / mass - c * c);
  const SceneRun run = run_scene("car", {"heave=0.005", "speed=0.5", "simulation.output_step=1e-3", "simulation.duration=2"});
  const Vector t = run.column("t"), z = run.column("y1").array() - (0.7 - mass * 9.81 / 2 / stiffness);
  std::vector<double> crossings;
  for (int k = 1; k < z.size(); ++k) {
    EXPECT_NEAR(z[k], heave * std::exp(-c * t[k]) * (std::cos(omega * t[k]) + c / omega * std::sin(omega * t[k])), 1e-9) << t[k];
    if ((z[k - 1] > 0) != (z[k] > 0)) crossings.push_back(t[k - 1] - z[k - 1] * (t[k] - t[k - 1]) / (z[k] - z[k - 1]));
  }
  ASSERT_GE(crossings.size(), 4u);
  const double measured = std::numbers::pi * 3 / (crossings[3] - crossings[0]);
  EXPECT_NEAR(std::hypot(measured, c), std::sqrt(2 * stiffness / mass), 1e-4) << "rad/s; crossings interpolated over 1 ms";
}

}  // namespace
}  // namespace tenon
