// Gap functions as geometry: distances that can be seen, and for every pair of shapes h' = H v and h'' = H vdot + Hdot v against
// differences along a motion.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tenon/tests/scene_run.hpp"

namespace tenon {
namespace {

template <int D>
contact::ContactDae<D> dae_of(const std::string& text) {
  return contact::ContactDae<D>(std::get<contact::Scene<D>>(contact::parse_scene(text, "scene.toml").scene));
}

/// Where a body is after dt at constant velocities, the angular one in its own axes.
Eigen::VectorXd moved(const contact::Positions<double, 2>& q, const contact::Velocities<double, 2>& v, double dt) {
  return q + dt * v;
}
Eigen::VectorXd moved(const contact::Positions<double, 3>& q, const contact::Velocities<double, 3>& v, double dt) {
  contact::Positions<double, 3> next = q;
  next.head<3>() += dt * v.head<3>();
  const Eigen::Vector3d turn = dt * v.tail<3>();
  const Eigen::Quaterniond r =
      Eigen::Quaterniond(q[3], q[4], q[5], q[6]) * Eigen::Quaterniond(Eigen::AngleAxisd(turn.norm(), turn.normalized()));
  next.tail<4>() << r.w(), r.x(), r.y(), r.z();
  return next;
}

/// Two rigid bodies: every constraint of the scene, at poses drawn around each other.
template <int D>
void check_gaps(const contact::ContactDae<D>& dae) {
  Dae::Workspace workspace = dae.make_workspace();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> draw(-1, 1);
  constexpr int nq = contact::kPositions<D>, nv = contact::kVelocities<D>;
  for (int sample = 0; sample < 40; ++sample) {
    contact::Positions<double, D> q[2];
    contact::Velocities<double, D> v[2];
    for (int body = 0; body < 2; ++body) {
      for (int l = 0; l < nq; ++l) q[body][l] = draw(random);
      for (int l = 0; l < nv; ++l) v[body][l] = draw(random);
      if constexpr (D == 3) q[body].template tail<4>().normalize();
    }
    const auto at = [&](double dt) {
      Vector x = Vector::Zero(dae.num_states());
      for (int body = 0; body < 2; ++body) {
        x.segment(body * (nq + nv), nq) = moved(q[body], v[body], dt);
        x.segment(body * (nq + nv) + nq, nv) = v[body];
      }
      return x;
    };
    for (int i = 0; i < dae.num_constraints(); ++i) {
      const double step = 1e-5;
      const auto now = dae.gap(i, 0, at(0), workspace), before = dae.gap(i, 0, at(-step), workspace),
                 after = dae.gap(i, 0, at(step), workspace);
      const std::string where = dae.algebraic_name(i) + ", sample " + std::to_string(sample);
      const double size = 1 + std::abs(now.bias);
      EXPECT_NEAR(now.hdot, (after.h - before.h) / (2 * step), 1e-7 * size) << where;
      EXPECT_NEAR(now.bias, (after.hdot - before.hdot) / (2 * step), 1e-6 * size * size) << where;
      double rate = 0;
      const auto& c = dae.scene().constraints[static_cast<std::size_t>(i)];
      if (c.a != contact::kWorld) rate += now.H_A.dot(v[c.a]);
      if (c.b != contact::kWorld) rate += now.H_B.dot(v[c.b]);
      EXPECT_NEAR(now.rate, rate, 1e-12) << where;
    }
  }
}

TEST(Gaps, RatesAndAccelerationsInThePlaneAreThoseOfTheMotion) {
  std::string text =
      "[[body]]\nname = \"a\"\nmass = 1.0\ninertia = 0.1\nposition = [3.0, 0.0]\n[[body]]\nname = \"b\"\nmass = 1.0\ninertia = 0.1\n";
  const std::vector<std::pair<std::string, std::string>> shapes{
      {"disc", "radius = 0.1\nat = [0.02, 0.01]"},
      {"point", "at = [0.1, 0.2]"},
      {"half-plane", "normal = [-0.3, 1.0]\npoint = [0.0, -5.0]"},
      {"capsule", "from = [-0.2, 0.0]\nto = [0.1, 0.1]\nradius = 0.05"},
      {"polygon", "vertices = [0.0, 0.0, 0.3, 0.1, 0.1, 0.4]"},
      {"box", "size = [0.2, 0.4]\nangle = 0.3"},
      {"hole", "width = 0.2\ndepth = 0.3\nchamfer = 0.05\nangle = 0.2\nat = [0.1, 0.1]"}};
  for (const char* body : {"a", "b"}) {
    for (const auto& [type, keys] : shapes)
      text += "[[shape]]\nname = \"" + type + "_" + body + "\"\nbody = \"" + body + "\"\ntype = \"" + type + "\"\n" + keys + "\n";
  }
  for (const auto& [type, _] : shapes) {
    for (const auto& [other, _2] : shapes) {
      const bool has_corner = type != "half-plane" || other != "half-plane",
                 has_side = (type != "point" && type != "disc") || (other != "point");
      if (!has_corner || !has_side) continue;
      text += "[[contact]]\nname = \"" + type + "_" + other + "\"\nbetween = [\"" + type + "_a\", \"" + other + "_b\"]\n";
    }
  }
  check_gaps(dae_of<2>(text));
}

TEST(Gaps, RatesAndAccelerationsInSpaceAreThoseOfTheMotion) {
  std::string text =
      "[simulation]\nspace = \"spatial\"\n[[body]]\nname = \"a\"\nmass = 1.0\ninertia = [0.1, 0.1, 0.1]\nposition = [3.0, 0.0, "
      "0.0]\n[[body]]\nname = \"b\"\nmass = 1.0\ninertia = [0.1, 0.1, 0.1]\n";
  const std::vector<std::pair<std::string, std::string>> shapes{{"sphere", "radius = 0.1\nat = [0.02, 0.01, 0.1]"},
                                                                {"half-space", "normal = [-0.3, 1.0, 0.2]\npoint = [0.0, -5.0, 0.0]"},
                                                                {"capsule", "from = [-0.2, 0.0, 0.1]\nto = [0.1, 0.1, 0.3]\nradius = 0.05"},
                                                                {"box", "size = [0.2, 0.4, 0.3]"}};
  for (const char* body : {"a", "b"}) {
    for (const auto& [type, keys] : shapes)
      text += "[[shape]]\nname = \"" + type + "_" + body + "\"\nbody = \"" + body + "\"\ntype = \"" + type + "\"\n" + keys + "\n";
  }
  for (const auto& [type, _] : shapes) {
    for (const auto& [other, _2] : shapes) {
      if (type == "half-space" && other == "half-space") continue;
      text += "[[contact]]\nname = \"" + type + "_" + other + "\"\nbetween = [\"" + type + "_a\", \"" + other + "_b\"]\n";
    }
  }
  check_gaps(dae_of<3>(text));
}

const std::string kProbe = R"(
[[body]]
name = "probe"
kind = "point"
mass = 1.0
[[shape]]
body = "probe"
type = "point"
[[shape]]
name = "hole"
type = "hole"
width = 0.02
depth = 0.03
chamfer = 0.002
rim = 0.05
[[contact]]
name = "hole"
between = ["probe", "hole"]
)";

// Cheeks at x = -/+ .01 up to y = -.002, chamfers at 45 degrees up to x = -/+ .012, the floor at y = -.03.
TEST(Hole, StandsAsFarAsItLooks) {
  const auto dae = dae_of<2>(kProbe);
  Dae::Workspace workspace = dae.make_workspace();
  enum { left, right, floor };
  const auto gap = [&](int part, double x, double y) {
    return dae.gap(part, 0, (Vector(dae.num_states()) << x, y, 0, 0, 0, 0, 0).finished(), workspace);
  };
  EXPECT_NEAR(gap(left, 0.004, -0.02).h, 0.014, 1e-15);
  EXPECT_NEAR(gap(right, 0.004, -0.02).h, 0.006, 1e-15);
  EXPECT_NEAR(gap(floor, 0.004, -0.02).h, 0.01, 1e-15);
  EXPECT_EQ(gap(right, 0.004, -0.02).normal, Eigen::Vector2d(-1, 0));
  // over the chamfer's face, and inside it
  for (const double over : {0.0015, 0.0, -0.0002}) {
    const auto chamfer = gap(right, 0.011 - over / std::sqrt(2), -0.001 + over / std::sqrt(2));
    EXPECT_NEAR(chamfer.h, over, 1e-15);
    EXPECT_NEAR(chamfer.normal[1], std::sqrt(0.5), 1e-14);
  }
  // over the rim, over its edge
  EXPECT_NEAR(gap(left, -0.03, 0.005).h, 0.005, 1e-15);
  EXPECT_NEAR(gap(left, -0.012 + 0.0001, 0.003).h, std::hypot(0.0001, 0.003), 1e-15);
}

TEST(Hole, WithoutAChamferHasSquareEdges) {
  std::string text = kProbe;
  text.replace(text.find("chamfer = 0.002"), 15, "chamfer = 0.0");
  const auto dae = dae_of<2>(text);
  Dae::Workspace workspace = dae.make_workspace();
  EXPECT_NEAR(dae.gap(1, 0, (Vector(dae.num_states()) << 0.007, 0.004, 0, 0, 0, 0, 0).finished(), workspace).h, 0.005, 1e-15);
}

TEST(PegAndHole, ChamferAndCheeksLeadThePegDown) {
  const SceneRun run = run_scene("peg-and-hole");
  const Vector energy = run.column("energy");
  EXPECT_LT(run.largest("energy_error"), 1e-6 * (energy.maxCoeff() - energy.minCoeff()));
  EXPECT_GE(run.events_to(1).size(), 20u);
  EXPECT_EQ(run.events.front().contact, "hole_8") << "its lower right corner meets the chamfer at the right";
  EXPECT_NEAR(run.last("y1"), -0.025 + 0.02, 1e-9) << "it stands on the floor";
  EXPECT_NEAR(run.last("theta1"), 0, 1e-9);
  EXPECT_LE(std::abs(run.last("x1")), 0.2e-3 + 1e-9) << "between the cheeks";
  EXPECT_NEAR(run.last("lambda_hole_13") + run.last("lambda_hole_14"), 0.3 * 9.81, 1e-8);
  for (const std::string& name : run.names) {
    if (!name.starts_with("gap_")) continue;
    EXPECT_GT(run.smallest(name), -2e-9) << name;
  }
}

}  // namespace
}  // namespace tenon
