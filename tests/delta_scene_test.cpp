// The delta robot simulated: energy, closure, tracking, contact, as its scenes promise.
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <map>

#include "tenon/core/csv.hpp"
#include "tenon/core/input_error.hpp"
#include "tenon/core/trajectory.hpp"
#include "tenon/problems/delta/scene_dae.hpp"
#include "tenon/problems/delta/scene_file.hpp"
#include "tenon/problems/delta/tactile_loop.hpp"
#include "tenon/solvers/make_integrator.hpp"
#include "tenon/tests/expect_message.hpp"

namespace tenon::delta {
namespace {

const std::filesystem::path kSourceDir = TENON_SOURCE_DIR;
using Overrides = std::vector<std::string>;

/// A scene's run at its output steps.
struct Record {
  Scene scene;
  IntegrationResult result;
  std::vector<DaeState> states;
  std::vector<DaeEvent> events;
  std::map<std::string, std::vector<double>> columns;

  const std::vector<double>& operator[](const std::string& name) const { return columns.at(name); }
  std::size_t size() const { return columns.at("t").size(); }
  Vector3 error(std::size_t k) const {
    const auto at = [&](const char* name) { return columns.at(name)[k]; };
    return {at("zx") - at("rx"), at("zy") - at("ry"), at("zz") - at("rz")};
  }
  double largest(const std::string& name) const { return *std::ranges::max_element(columns.at(name)); }
  /// rms of |error| from `begin` on, m.
  double rms(double begin) const {
    double sum = 0;
    int count = 0;
    for (std::size_t k = 0; k < size(); ++k) {
      if (columns.at("t")[k] < begin - 1e-9) continue;
      sum += error(k).squaredNorm();
      ++count;
    }
    return std::sqrt(sum / count);
  }
  double largest_error(double begin) const {
    double most = 0;
    for (std::size_t k = 0; k < size(); ++k) {
      if (columns.at("t")[k] >= begin) most = std::max(most, error(k).norm());
    }
    return most;
  }
};

Record record(const std::string& name, const Overrides& overrides = {}, const std::string& integrator = "dop853") {
  Record out;
  out.scene = load_scene(name, overrides);
  const SceneDae dae(out.scene);
  Dae::Workspace workspace = dae.make_workspace();
  const std::vector<std::string> names = trajectory_columns(dae);
  std::vector<double> row;
  IntegratorOptions options;
  options.rtol = out.scene.rtol;
  options.atol = 1e-2 * out.scene.rtol;
  options.output_step = out.scene.output_step;
  options.on_output = [&](const DaeState& state) {
    trajectory_row(dae, state, workspace, row);
    for (std::size_t c = 0; c < names.size(); ++c) out.columns[names[c]].push_back(row[c]);
    out.states.push_back(state);
    return true;
  };
  options.on_event = [&](const DaeEvent& event) { out.events.push_back(event); };
  DaeState state = initial_state_of(dae);
  out.result = make_integrator(integrator, dae, options)->advance(state, out.scene.duration);
  EXPECT_EQ(out.result.status, IntegrationStatus::reached) << name << ": " << out.result.explanation;
  return out;
}

double energy_drift(const Record& r) {
  const ArmConstants k(r.scene.robot);
  double drift = 0, kinetic = 0;
  for (std::size_t i = 0; i < r.size(); ++i) {
    drift = std::max(drift, std::abs(r["energy"][i] - r["energy"][0]));
    kinetic = std::max(kinetic, kinetic_energy(k, Configuration(Vector9(r.states[i].x.head<9>())), r.states[i].x.segment<9>(9)));
  }
  return drift / kinetic;
}

TEST(DeltaScenes, AllAreThere) {
  EXPECT_EQ(builtin_scenes(),
            (std::vector<std::string>{"delta-circle", "delta-free-fall", "delta-grasp", "delta-impact-hard", "delta-impact-soft",
                                      "delta-joystick", "delta-singularity", "delta-step", "delta-wall"}));
  for (const std::string& name : builtin_scenes()) EXPECT_FALSE(describe_builtin_scene(name).empty());
}

TEST(DeltaScenes, DerivativesSolveTheResidualAndTheJacobianIsItsDerivative) {
  for (const std::string& name : builtin_scenes()) {
    SCOPED_TRACE(name);
    Scene scene = load_scene(name, {"tool.angle=[0.1,0.2,0.3]"});
    const SceneDae dae(scene);
    Dae::Workspace workspace = dae.make_workspace();
    DaeState s = initial_state_of(dae);
    const int nx = dae.num_states(), n = nx + dae.num_algebraics();
    for (int i = 0; i < dae.num_guards(); ++i)
      s.mode.discrete[static_cast<std::size_t>(i)] = 2;  // whatever the gap: the law of a touching contact
    std::srand(1);
    s.x += 0.01 * Vector::Random(nx);
    s.t = 0.7;
    dae.derivatives(s.mode, s.t, s.x, s.u, workspace, s.xdot, s.y);
    Vector F(n), plus(n), minus(n);
    dae.residual(s.mode, DaePoint(s), workspace, F);
    const double size = s.xdot.lpNorm<Eigen::Infinity>() + s.y.lpNorm<Eigen::Infinity>();
    EXPECT_LE(F.lpNorm<Eigen::Infinity>(), 1e-12 * (1 + size));
    std::vector<double> values(static_cast<std::size_t>(n * n));
    constexpr double kAlpha = 3, kStep = 1e-6;
    dae.jacobian(s.mode, DaePoint(s), kAlpha, workspace, values);
    const Eigen::Map<Eigen::MatrixXd> J(values.data(), n, n);
    for (int k = 0; k < n; ++k) {
      const auto moved = [&](double step, Vector& out) {
        DaeState at = s;
        if (k < nx)
          at.x[k] += step, at.xdot[k] += kAlpha * step;
        else
          at.y[k - nx] += step;
        dae.residual(at.mode, DaePoint(at), workspace, out);
      };
      moved(kStep, plus);
      moved(-kStep, minus);
      const Vector column = (plus - minus) / (2 * kStep);
      EXPECT_LE((J.col(k) - column).lpNorm<Eigen::Infinity>(), 1e-6 * (1 + column.lpNorm<Eigen::Infinity>() + size)) << "column " << k;
    }
  }
}

TEST(DeltaScenes, FreeFallKeepsItsEnergyAndItsArmsClosed) {
  for (const char* integrator : {"dop853", "ida"}) {
    const Record fall = record("delta-free-fall", {}, integrator);
    EXPECT_LE(energy_drift(fall), 1e-10) << integrator;
    EXPECT_LE(fall.largest("closure"), 1e-10) << integrator;
  }
}

TEST(DeltaScenes, TheWorkOfEveryForceIsAccountedFor) {
  for (const std::string& name : builtin_scenes()) {
    const Record all = record(name, {"push.constant=[0.1,0.2,0.1]", "tool.reference=[1,0,0]", "simulation.rtol=1e-9"});
    double largest = 0;
    for (const double error : all["energy_error"]) largest = std::max(largest, std::abs(error));
    EXPECT_LE(largest, 1e-7) << name;
  }
}

TEST(DeltaScenes, TheFallGoesThroughTypeTwo) {
  for (const char* integrator : {"dop853", "ida"}) {
    const Record fall = record("delta-singularity", {}, integrator);
    EXPECT_GT(fall["det_a"].front(), 0.1);
    EXPECT_LT(fall["det_a"].back(), 0);
    EXPECT_LE(energy_drift(fall), 1e-9) << integrator;
    EXPECT_LE(fall.largest("closure"), 1e-10) << integrator;
  }
}

TEST(DeltaScenes, TheFourTrackingRowsAreThePublishedOnes) {
  EXPECT_LE(record("delta-circle").rms(2), 1e-9);
  EXPECT_NEAR(record("delta-circle", {"feed_forward=false"}).rms(2), 4.119e-3, 4.119e-5);
  EXPECT_NEAR(record("delta-circle", {"coriolis=false"}).rms(2), 0.508e-3, 0.508e-5);
  EXPECT_NEAR(record("delta-circle", {"coriolis=false", "inertia=projected-left"}).rms(2), 26.8e-3, 0.268e-3);
}

TEST(DeltaScenes, TheStepIsThatOfThreePolesAtSeven) {
  const Record step = record("delta-step");
  for (std::size_t k = 0; k < step.size(); ++k) {
    const double t = step["t"][k], decay = (1 + 7 * t - 49 * t * t) * std::exp(-7 * t);
    EXPECT_LE((step.error(k) - decay * Vector3(-0.02, -0.01, -0.02)).lpNorm<Eigen::Infinity>(), 1e-9) << "t = " << t;
  }
  const std::filesystem::path reference = kSourceDir / "../shared/reference/deltaB_step_exact.csv";
  if (!std::filesystem::exists(reference)) GTEST_SKIP() << reference << " is not there";
  const CsvTable table = read_csv(reference.string());
  ASSERT_LE(static_cast<std::size_t>(table.rows()), step.size());
  for (std::size_t k = 0; k < static_cast<std::size_t>(table.rows()); ++k) {
    ASSERT_NEAR(table["t"][k], step["t"][k], 1e-9);
    EXPECT_LE((step.error(k) - Vector3(table["ex"][k], table["ey"][k], table["ez"][k])).lpNorm<Eigen::Infinity>(), 1e-7);
  }
}

TEST(DeltaScenes, WithRealSensorsAndADisturbanceTheWristStaysWithinThirtyMicrometres) {
  for (const char* push : {"[0.3,0,0]", "[0,-0.3,0]", "[0,0,0.3]", "[0,0,-0.3]", "[-0.1732,0.1732,0.1732]"}) {
    const Record held = record("delta-step", {"controller.mode=sampled", "controller.rate=10000", "controller.delay=1",
                                              "controller.encoder_bits=20", "controller.filter=500", std::string("push.constant=") + push,
                                              "simulation.rtol=1e-6", "simulation.output_step=0.1"});
    EXPECT_LE(held.largest_error(3), 30e-6) << push;
  }
}

TEST(DeltaScenes, AJoystickLeadsTheWristToWithinThirtyMicrometresOfWhereItStops) {
  const Record led = record("delta-joystick");
  EXPECT_GT(led.largest_error(0), 5e-3);  // no feed-forward
  EXPECT_LE(led.largest_error(7), 30e-6);
}

TEST(DeltaScenes, IdaConfirmsTheOneStepMethodsAndEveryContact) {
  for (const char* name : {"delta-circle", "delta-wall", "delta-grasp", "delta-impact-hard", "delta-impact-soft"}) {
    const Overrides shorter{"simulation.duration=1.7", "simulation.rtol=1e-9"};
    const Record ida = record(name, shorter, "ida");
    for (const char* method : {"dop853", "dopri5"}) {
      SCOPED_TRACE(std::string(name) + " by " + method);
      const Record one_step = record(name, shorter, method);
      ASSERT_EQ(one_step.events.size(), ida.events.size());
      for (std::size_t k = 0; k < ida.events.size(); ++k) {
        EXPECT_EQ(one_step.events[k].contact, ida.events[k].contact);
        EXPECT_EQ(one_step.events[k].to, ida.events[k].to);
        EXPECT_NEAR(one_step.events[k].t, ida.events[k].t, 1e-7);
      }
      EXPECT_LE((one_step.states.back().x.head<9>() - ida.states.back().x.head<9>()).lpNorm<Eigen::Infinity>(), 1e-6);  // rad
    }
  }
}

TEST(DeltaScenes, ARecordHasOneRowForEachOutputStepAndTwoForEachContact) {
  const Record grasp = record("delta-grasp", {"simulation.duration=1.5"}, "dopri5");
  EXPECT_EQ(grasp.size(), 151 + 2 * grasp.events.size());
  // the torques of a row are those that its tick has sent: they still stand half a period later
  const Record fine = record("delta-joystick", {"simulation.output_step=5e-4", "simulation.duration=0.5"}, "dopri5");
  ASSERT_EQ(fine.size(), 1001U);
  for (std::size_t k = 0; k < fine.size(); ++k) {
    EXPECT_NEAR(fine["t"][k], 5e-4 * static_cast<double>(k), 1e-12);
    if (k % 2 == 1) {
      EXPECT_EQ(fine["tau1"][k], fine["tau1"][k - 1]);
    }
  }
}

TEST(DeltaScenes, TheWallIsTouchedOnceAndTheForceSettles) {
  for (const Overrides& change : {Overrides{},
                                  {"controller.payload=0.08"},
                                  {"controller.payload=0.12"},
                                  {"controller.delay=2"},
                                  {"controller.payload=0.12", "controller.delay=2"}}) {
    const Record wall = record("delta-wall", change);
    ASSERT_EQ(wall.events.size(), 1U);
    EXPECT_EQ(wall.events[0].to, 2);
    const std::vector<double>& force = wall["lambda_wall"];
    EXPECT_NEAR(force.back(), 600 * 0.008 / (1 + 600 / 1e4),
                0.5);  // two springs in a row, and the weight that the controller is wrong about
    for (std::size_t k = 0; k < force.size(); ++k) {
      if (wall["t"][k] > 3.5) {
        EXPECT_NEAR(force[k], force.back(), 1e-3);
      }
    }
    EXPECT_LE(wall.largest("lambda_wall"), 1.1 * force.back());
  }
}

TEST(DeltaScenes, TheGraspClosesWithoutSwitchingAndBothFingersShareTheForce) {
  for (const Overrides& change : {Overrides{},
                                  {"controller.payload=0.12"},
                                  {"controller.payload=0.18"},
                                  {"controller.delay=2"},
                                  {"controller.payload=0.18", "controller.delay=2"}}) {
    const Record grasp = record("delta-grasp", change);
    ASSERT_EQ(grasp.events.size(), 2U);  // each finger touches once and stays
    EXPECT_NEAR(grasp["lambda_left"].back(), grasp["lambda_right"].back(), 0.02);
    EXPECT_NEAR(grasp["lambda_left"].back(), 2000 * 0.0005, 0.03);
    EXPECT_NEAR(grasp["object"].back(), 0.006, 1e-4);
  }
  const Record blind = record("delta-grasp", {"tactile_gain=0"});
  EXPECT_GT(std::abs(blind["lambda_left"].back() - blind["lambda_right"].back()), 1);
}

TEST(DeltaScenes, TheTactileLoopIsStableUpToItsDelayMarginAndNotBeyond) {
  const Scene grasp = load_scene("delta-grasp");
  const LoopMargins margins = TactileLoop(grasp).margins();
  EXPECT_GT(margins.phase, 60);
  const auto unrest = [&](double delay) {
    const int ticks = static_cast<int>(delay / grasp.controller.period);
    const Record held = record("delta-grasp", {"controller.delay=" + std::to_string(ticks), "simulation.duration=8"});
    double least = 1e9, most = -1e9;
    for (std::size_t k = 0; k < held.size(); ++k) {
      if (held["t"][k] < 6) continue;
      const double difference = held["lambda_left"][k] - held["lambda_right"][k];
      least = std::min(least, difference), most = std::max(most, difference);
    }
    return most - least;
  };
  EXPECT_LT(unrest(0.7 * margins.delay), 1e-2);
  EXPECT_GT(unrest(1.3 * margins.delay), 0.2);
}

TEST(DeltaScenes, ImpedanceControlKeepsTheForceOfAnImpactDown) {
  const Record hard = record("delta-impact-hard"), soft = record("delta-impact-soft");
  EXPECT_GT(hard.largest("lambda_wall"), 3 * soft.largest("lambda_wall"));
  // the motors are at their limits, the integrator with them, and the robot is stable and says so
  EXPECT_EQ(hard.largest("saturated"), 1);
  EXPECT_EQ(hard.largest("tau1"), 4);
  for (std::size_t k = 0; k < hard.size(); ++k) {
    if (hard["t"][k] > 1.8) {
      EXPECT_NEAR(hard["zz"][k], hard["zz"].back(), 1e-4);
    }
  }
}

TEST(DeltaScenes, TheGimbalsTurnTheToolToItsReference) {
  const Overrides sampled{"controller.mode=sampled", "controller.rate=1000", "controller.delay=1", "controller.filter=200"};
  for (Overrides overrides : {Overrides{}, sampled}) {
    for (const char* text : {"tool.angle=[0,0,0]", "tool.reference=[0.5,-0.3,1]", "simulation.duration=3"}) overrides.emplace_back(text);
    const Record turned = record("delta-step", overrides);
    EXPECT_NEAR(turned["yaw"].back(), 0.5, 1e-9);
    EXPECT_NEAR(turned["pitch"].back(), -0.3, 1e-9);
    EXPECT_NEAR(turned["roll"].back(), 1, 1e-9);
    EXPECT_LE(turned.largest_error(2.9), 1e-5);
  }
  // as a spring and a damper
  const Record soft = record("delta-wall", {"tool.angle=[0.2,0,0]", "tool.reference=[0.5,-0.3,1]"});
  EXPECT_NEAR(soft["roll"].back(), 1, 1e-6);
}

TEST(DeltaScenes, RefuseWhatMakesNoSense) {
  EXPECT_MESSAGE(load_scene("delta-cirle"), std::invalid_argument, "the nearest is 'delta-circle'");
  EXPECT_MESSAGE(load_scene("delta-circle", {"radius=0.6"}), InputError, "is out of reach, 0.");
  EXPECT_MESSAGE(load_scene("delta-circle", {"radus=0.06"}), InputError,
                 "unknown key 'radus' in parameters; the nearest known key is 'radius'");
  EXPECT_MESSAGE(load_scene("delta-circle", {"inertia=exakt"}), InputError, "inertia is 'exakt', the nearest is 'exact'");
  EXPECT_MESSAGE(load_scene("delta-step", {"start.position=[0,0,0.7]"}), InputError,
                 "the wrist starts out of reach, 0.0519259 m from the workspace");
  EXPECT_MESSAGE(load_scene("delta-step", {"robot.proximal_length=-1"}), InputError, "proximal_length is -1 m (expected more than 0)");
  EXPECT_MESSAGE(load_scene("delta-joystick", {"controller.rate=0"}), InputError, "rate is 0 (expected more than 0)");
  EXPECT_MESSAGE(load_scene("delta-step", {"controller.delay=1"}), InputError, "delay belongs to a sampled controller");
  EXPECT_MESSAGE(load_scene("delta-wall", {"controller.payload=-1"}), InputError, "payload is -1 kg");
  EXPECT_MESSAGE(load_scene("delta-wall", {"contact.1.stiffness=0"}), InputError, "stiffness is 0 N/m");
  EXPECT_MESSAGE(load_scene("delta-wall", {"push.on=object"}), InputError, "there is no object");
  EXPECT_MESSAGE(load_scene("delta-wall", {"simulation.duration=-1"}), InputError, "duration is -1 s");
  EXPECT_MESSAGE(SceneDae(load_scene("delta-step", {"start.position=[0,0,0.648074069840786]", "start.velocity=[0,0,1]"})),
                 std::invalid_argument, "singularity");
}

}  // namespace
}  // namespace tenon::delta
