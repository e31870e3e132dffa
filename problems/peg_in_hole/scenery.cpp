#include "tenon/problems/peg_in_hole/scenery.hpp"

namespace tenon::peg {

namespace {

constexpr double kMetre = 1e-3;  // of a millimetre
constexpr double kPegLength = 40, kHoleDepth = 25, kBlock = 20;  // mm

SceneryShape block(const Geometry& g, double side) {
  const double half = g.half_opening(), outer = half + g.chamfer + kBlock;
  std::vector<Eigen::Vector2d> corners = {{side * half, -kHoleDepth}, {side * outer, -kHoleDepth}, {side * outer, 0},
                                          {side * (half + g.chamfer), 0}, {side * half, -g.chamfer}};
  for (Eigen::Vector2d& corner : corners) corner *= kMetre;
  return SceneryShape::polygon(corners).colored("ground");
}

/// Seen enlarged: the mouth's two edges and the peg's lower corners.
std::vector<SceneryLens> lenses(const Geometry& g) {
  constexpr double kExtent = 3 * kMetre;
  const double edge = (g.half_opening() + g.chamfer / 2) * kMetre, corner = g.width / 2 * kMetre, below = -0.7 * g.chamfer * kMetre;
  return {{.name = "mouth, left", .body = "hole", .at = {-edge, below}, .extent = kExtent},
          {.name = "mouth, right", .body = "hole", .at = {edge, below}, .extent = kExtent},
          {.name = "peg, left", .body = "peg", .at = {-corner, 0}, .extent = kExtent},
          {.name = "peg, right", .body = "peg", .at = {corner, 0}, .extent = kExtent}};
}

/// The force of each contact where it acts: at a corner of the peg, or at the lower or the upper edge of a chamfer.
std::vector<SceneryArrow> pushes(const Geometry& g) {
  std::vector<SceneryArrow> arrows;
  for (std::size_t i = 0; i < kContacts; ++i) {
    const double side = side_of(static_cast<int>(i)), opening = g.half_opening();
    const SceneryPoint corner{.body = "peg", .at = {side * g.width / 2 * kMetre, 0, 0}},
        lower{.body = "hole", .at = {side * opening * kMetre, -g.chamfer * kMetre, 0}},
        upper{.body = "hole", .at = {side * (opening + g.chamfer) * kMetre, 0, 0}};
    const std::string name = kContactNames[i];
    arrows.push_back({.name = name, .at = i < 2 ? corner : i < 4 ? lower : upper, .vector = {"push_x_" + name, "push_z_" + name, 0},
                      .frame = "world"});
  }
  return arrows;
}

std::string covariance(const std::string& a, const std::string& b) {
  return "cov_estimate_hole_" + a + "_estimate_hole_" + b;
}

SceneryEstimate::Axis axis(const std::string& quantity, const std::string& unit) {
  return {quantity, unit, "estimate_hole_" + quantity, "hole_" + quantity};
}

SceneryPlot truth_and_estimate(const std::string& title, const std::string& unit, const std::string& quantity) {
  const std::string mean = "estimate_hole_" + quantity;
  return {.title = title, .unit = unit, .columns = {"hole_" + quantity, mean}, .bands = {{mean, covariance(quantity, quantity)}}};
}

}  // namespace

Scenery scenery_of(const AssemblyProblem& problem, bool height_is_known) {
  const Geometry& g = problem.geometry;
  Scenery scenery;
  SceneryBody hole{.name = "hole", .position = {"hole_x", "hole_z", 0}, .angle = SceneryValue("hole_theta")};
  hole.shapes = {block(g, -1), block(g, 1)};
  SceneryBody peg{.name = "peg", .position = {"x", "z", 0}, .angle = SceneryValue("theta"), .trail = true};
  peg.shapes = {SceneryShape::box({g.width * kMetre, kPegLength * kMetre, 0}).at({0, kPegLength * kMetre / 2, 0})};
  SceneryBody believed{.name = "believed hole", .position = {"estimate_hole_x", "estimate_hole_z", 0},
                       .angle = SceneryValue("estimate_hole_theta"), .outline = true};
  believed.shapes = hole.shapes;
  scenery.bodies = {hole, peg, believed};
  scenery.extent = 0.05;
  scenery.arrows = pushes(g);
  scenery.ghosts = {{.body = "peg", .count = problem.intervals, .position = {"plan_x#", "plan_z#", 0}, .angle = SceneryValue("plan_theta#")}};
  const std::array<SceneryValue, 6> spread{covariance("x", "x"), covariance("x", "z"), covariance("x", "theta"),
                                           covariance("z", "z"), covariance("z", "theta"), covariance("theta", "theta")};
  for (const double side : {-1.0, 1.0})
    scenery.ellipses.push_back({"believed hole", Eigen::Vector2d(side * g.half_opening(), -g.chamfer) * kMetre, spread});
  scenery.lenses = lenses(g);

  scenery.estimates = {{"Hole, across and tilted", axis("x", "m"), axis("theta", "rad"),
                        {covariance("x", "x"), covariance("x", "theta"), covariance("theta", "theta")}}};
  scenery.plots = {truth_and_estimate("Hole across: truth, estimate and 2 standard deviations", "m", "x"),
                   truth_and_estimate("Hole's tilt: truth, estimate and 2 standard deviations", "rad", "theta")};
  if (!height_is_known) {
    scenery.estimates.push_back({"Hole, across and in height", axis("x", "m"), axis("z", "m"),
                                 {covariance("x", "x"), covariance("x", "z"), covariance("z", "z")}});
    scenery.plots.push_back(truth_and_estimate("Hole's height: truth, estimate and 2 standard deviations", "m", "z"));
  }
  scenery.plots.push_back({.title = "Depth", .unit = "m", .columns = {"depth"}});
  scenery.plots.push_back({.title = "Contact force on the peg, and its peak since the tick before", .unit = "N",
                           .columns = {"Fx", "Fz", "peak_force"}});
  const auto motion = [&](const std::string& title, const std::string& unit, const std::string& axis) {
    scenery.plots.push_back({.title = title, .unit = unit, .columns = {axis, "reference_" + axis},
                             .foresights = {{"plan_" + axis + "#", problem.intervals, problem.interval}}});
  };
  motion("Peg across, its reference and the plan", "m", "x");
  motion("Peg's height, its reference and the plan", "m", "z");
  motion("Peg's tilt, its reference and the plan", "rad", "theta");
  return scenery;
}

}  // namespace tenon::peg
