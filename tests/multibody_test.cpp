// Bodies in the plane and in space against mechanics' own results: pendula as constraint chains, a free top, balls on planes; and what is
// said of scenes that make no sense.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tenon/core/input_error.hpp"
#include "tenon/problems/contact/contact_dae.hpp"
#include "tenon/tests/scene_run.hpp"

namespace tenon {
namespace {

contact::SceneFile scene(const std::string& text) {
  return contact::parse_scene(text, "scene.toml");
}

const std::string kPendulum = R"(
[simulation]
gravity = [0.0, -9.81]
duration = 10.0
output_step = 0.001
rtol = 1e-10
[[body]]
name = "bob"
kind = "point"
mass = 1.0
position = [0.8414709848078965, -0.5403023058681398]
[[joint]]
name = "rod"
type = "distance"
between = ["bob", "world"]
to = [0.0, 0.0]
)";

TEST(Pendulum, KeepsItsEnergyAndCrossesWhenTheEllipticIntegralSays) {
  const SceneRun run = run_scene(scene(kPendulum));
  const Vector energy = run.column("energy"), x = run.column("x1"), v = run.column("vx1"), t = run.column("t");
  const double swing = 9.81 * (1 - std::cos(1.0));
  EXPECT_LT((energy.array() - energy[0]).abs().maxCoeff(), 1e-8 * swing);
  // T = 4 sqrt(l/g) K(sin(theta0/2)); the first crossing is at T/4, then every T/2
  const double quarter = std::sqrt(1 / 9.81) * std::comp_ellint_1(std::sin(0.5));
  int crossings = 0;
  for (int k = 1; k < x.size(); ++k) {
    if ((x[k - 1] > 0) == (x[k] > 0)) continue;
    // cubic of positions and velocities: far more accurate over a millisecond than asked for
    const double h = t[k] - t[k - 1];
    double s = x[k - 1] / (x[k - 1] - x[k]);
    for (int n = 0; n < 5; ++n) {
      const double s2 = s * s, s3 = s2 * s;
      const double value =
          (2 * s3 - 3 * s2 + 1) * x[k - 1] + (s3 - 2 * s2 + s) * h * v[k - 1] + (3 * s2 - 2 * s3) * x[k] + (s3 - s2) * h * v[k];
      s -= value / (h * v[k]);
    }
    EXPECT_NEAR(t[k - 1] + s * h, quarter * (1 + 2 * crossings), 1e-7) << crossings;
    ++crossings;
  }
  EXPECT_GE(crossings, 9);
}

TEST(DoublePendulum, KeepsItsEnergy) {
  const SceneRun run = run_scene(scene(kPendulum + R"(
[[body]]
name = "second"
kind = "point"
mass = 0.5
position = [1.8414709848078965, -0.5403023058681398]
[[joint]]
name = "second_rod"
type = "distance"
between = ["second", "bob"]
)"));
  const Vector energy = run.column("energy");
  EXPECT_LT((energy.array() - energy[0]).abs().maxCoeff(), 1e-8 * 20) << "of a swing of about 20 J";
}

const std::string kTop = R"(
[simulation]
space = "spatial"
duration = 5.0
rtol = 1e-10
[[body]]
name = "top"
mass = 2.0
inertia = [0.1, 0.2, 0.3]
omega = [0.1, 5.0, 0.2]
velocity = [1.0, -2.0, 0.5]
)";

TEST(FreeTop, KeepsEnergyAndAngularMomentumThroughItsTumbling) {
  const SceneRun run = run_scene(scene(kTop));
  const auto spin = [](const DaeState& s) -> Eigen::Vector3d {
    const Eigen::Quaterniond q(s.x[3], s.x[4], s.x[5], s.x[6]);
    return q.normalized() * Eigen::Vector3d(0.1 * s.x[10], 0.2 * s.x[11], 0.3 * s.x[12]);
  };
  const Vector energy = run.column("energy");
  EXPECT_LT((energy.array() - energy[0]).abs().maxCoeff(), 1e-8 * energy[0]);
  for (const DaeState& state : run.states) {
    EXPECT_LT((spin(state) - spin(run.states.front())).norm(), 1e-8);
    EXPECT_NEAR(state.x.segment<4>(3).norm(), 1, 1e-8);
  }
  EXPECT_GT((run.final.x.segment<3>(10) - run.states.front().x.segment<3>(10)).norm(), 1) << "the middle axis is unstable: it tumbles";
}

const std::string kSpatialContacts = R"(
[simulation]
space = "spatial"
gravity = [0.0, 0.0, -9.81]
duration = 2.0
[[body]]
name = "ball"
mass = 1.0
inertia = [0.004, 0.004, 0.004]
position = [0.0, 0.0, 0.5]
[[body]]
name = "box"
mass = 2.0
inertia = [0.02, 0.02, 0.02]
position = [1.0, 0.0, 0.3]
quaternion = [0.95, 0.2, 0.1, 0.05]
[[shape]]
body = "ball"
type = "sphere"
radius = 0.1
[[shape]]
body = "box"
type = "box"
size = [0.2, 0.2, 0.2]
[[shape]]
name = "ground"
type = "half-space"
normal = [0.0, 0.0, 1.0]
[[contact]]
name = "ball_ground"
between = ["ball", "ground"]
restitution = 0.5
[[contact]]
name = "box_ground"
between = ["box", "ground"]
restitution = 0.0
[[contact]]
name = "ball_box"
between = ["ball", "box"]
)";

TEST(SpatialContact, ABallAndABoxComeToRestWithTheirWeights) {
  const SceneRun run = run_scene(scene(kSpatialContacts));
  EXPECT_LT(run.largest("energy_error"), 1e-7);
  EXPECT_NEAR(run.last("lambda_ball_ground"), 9.81, 1e-7);
  EXPECT_NEAR(run.last("z1"), 0.1, 1e-8);
  double weight = 0;
  for (int k = 1; k <= 8; ++k) weight += run.last("lambda_box_ground_" + std::to_string(k));
  EXPECT_NEAR(weight, 2 * 9.81, 1e-2) << "flat on four corners, or nearly";
  for (const std::string& name : run.names) {
    if (!name.starts_with("gap_")) continue;
    EXPECT_GT(run.smallest(name), -1e-8) << name;
  }
}

TEST(SpatialContact, JacobiansAgreeWithDifferences) {
  check_jacobian(scene(kTop), 1e-6);
  check_jacobian(scene(kSpatialContacts), 1e-6);
}

// A ball thrown with back-spin: friction acts until it rolls, with 5/7 of the speed it would have without spin.
TEST(Friction, ASlidingBallEndsRolling) {
  const SceneRun run = run_scene(scene(R"(
[simulation]
gravity = [0.0, -9.81]
duration = 2.0
[[body]]
name = "ball"
mass = 1.0
inertia = 0.004
position = [0.0, 0.1]
velocity = [1.0, 0.0]
[[shape]]
body = "ball"
type = "disc"
radius = 0.1
[[shape]]
name = "ground"
type = "half-plane"
normal = [0.0, 1.0]
[[contact]]
name = "ground"
between = ["ball", "ground"]
friction = 0.2
)"));
  EXPECT_NEAR(run.last("vx1"), 5.0 / 7, 1e-3);
  EXPECT_NEAR(run.last("omega1"), -run.last("vx1") / 0.1, 1e-2);
  EXPECT_LT(run.largest("energy_error"), 1e-7) << "the work of friction is in the contact's";
}

std::string complaint(const std::string& text) {
  try {
    run_scene(scene(text));
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(BadScenes, AreToldWithTheirPlace) {
  EXPECT_NE(complaint(kPendulum + "colour = 1\n").find("scene.toml:17:1: unknown key 'colour'"), std::string::npos)
      << complaint(kPendulum + "colour = 1\n");
  EXPECT_NE(complaint(kPendulum + "[[body]]\nname = \"b\"\nmass = 0.0\n").find("'mass' is 0"), std::string::npos);
  EXPECT_NE(complaint(kPendulum + "[[shape]]\nbody = \"bib\"\ntype = \"point\"\n").find("unknown body 'bib', the nearest is 'bob'"),
            std::string::npos);
  EXPECT_NE(complaint(kPendulum + "[[shape]]\nbody = \"bob\"\ntype = \"dics\"\nradius = 1.0\n").find("the nearest is 'disc'"),
            std::string::npos);
  const std::string floor =
      "[[shape]]\nbody = \"bob\"\ntype = \"point\"\n[[shape]]\nname = \"floor\"\ntype = \"half-plane\"\nnormal = [0.0, 1.0]\n";
  EXPECT_NE(
      complaint(kPendulum + floor + "[[contact]]\nname = \"c\"\nbetween = [\"bob\", \"floor\"]\n").find("overlaps at the start by 0.54"),
      std::string::npos);
  EXPECT_NE(complaint(kPendulum + floor + "[[contact]]\nname = \"c\"\nbetween = [\"bob\", \"floor\"]\nrestitution = 1.5\n")
                .find("'restitution' is 1.5"),
            std::string::npos);
  EXPECT_NE(
      complaint(kPendulum + "[[joint]]\nname = \"j\"\ntype = \"distance\"\nbetween = [\"bob\", \"world\"]\nto = [0.0, 1.0]\nlength = 0.5\n")
          .find("cannot close"),
      std::string::npos);
  EXPECT_NE(
      complaint(kPendulum + "[[shape]]\nbody = \"bob\"\ntype = \"point\"\n[[shape]]\nname = \"line\"\ntype = \"segment\"\nfrom = [-1.0, "
                            "-2.0]\nto = [1.0, -2.0]\n[[contact]]\nname = \"c\"\nbetween = [\"bob\", \"line\"]\n")
          .find("neither has an inside"),
      std::string::npos);
  EXPECT_NE(complaint("[[body]]\nname = \"b\"\nmass = nan\n").find("finite"), std::string::npos);
}

}  // namespace
}  // namespace tenon
