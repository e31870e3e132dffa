#include "tenon/problems/pushed_block/task.hpp"

#include "tenon/problems/pushed_block/plant.hpp"
#include "tenon/problems/pushed_block/script.hpp"
#include "tenon/problems/toml/checked_keys.hpp"

namespace tenon::pushed_block {

namespace {

using toml_file::Table;

Parameters read_parameters(const Table& table) {
  Parameters p;
  p.finger_mass = positive(table, "finger_mass", p.finger_mass);
  p.stiffness = positive(table, "stiffness", p.stiffness);
  p.softness = positive(table, "softness", p.softness);
  p.slip_speed = positive(table, "slip_speed", p.slip_speed);
  p.gravity = positive(table, "gravity", p.gravity);
  p.noise = positive(table, "noise", p.noise);
  p.force_ripple = not_negative(table, "force_ripple", p.force_ripple);
  p.friction_ripple = not_negative(table, "friction_ripple", p.friction_ripple);
  p.period = positive(table, "period", p.period);
  return p;
}

Path read_path(const Table& table) {
  Path path;
  path.speed = positive(table, "speed", path.speed);
  const std::string motion = table.text("motion", "shaken");
  if (motion == "rest")
    path.moves = false;
  else if (motion == "shaken")
    path.depth = 0.7;
  else if (motion != "steady")
    throw InputError(table.position("motion"), "unknown motion '" + motion + "'", "rest, steady or shaken");
  return path;
}

/// [block] as it is, [believed] of it as pairs of mean and deviation.
State read_block(const Table& root) {
  const Table table = required_table(root, "block", {"place", "mass", "friction"});
  State x = State::Zero();
  x[kBlock] = positive(table, "place", 0);
  x[kBlockMass] = positive(table, "mass", 0);
  x[kFriction] = positive(table, "friction", 0);
  return x;
}

Prior read_prior(const Table& root) {
  const Table table = required_table(root, "believed", {"place", "mass", "friction"});
  Prior prior;
  prior.deviation[kFinger] = 1e-4;                                    // m: where it starts
  prior.deviation[kFingerRate] = prior.deviation[kBlockRate] = 0.01;  // m/s: both are at rest, as far as one sees
  for (const auto& [key, i] : {std::pair{"place", kBlock}, {"mass", kBlockMass}, {"friction", kFriction}}) {
    const Eigen::Vector2d pair = centre_and_deviation(table, key, "mean");
    prior.mean[i] = pair[0];
    prior.deviation[i] = pair[1];
  }
  return prior;
}

Scenery draw() {
  constexpr double kSize = 0.06;
  Scenery out;
  out.bodies.push_back({.name = "table", .shapes = {SceneryShape::half_space({0, 1, 0}, {0, -kSize / 2, 0})}});
  out.bodies.push_back({.name = "finger",
                        .position = {"finger", 0, 0},
                        .shapes = {SceneryShape::capsule({-1.5 * kSize, 0, 0}, {-kSize / 6, 0, 0}, kSize / 6)}});
  out.bodies.push_back(
      {.name = "block", .position = {"block", 0, 0}, .shapes = {SceneryShape::box({kSize, kSize, 0}).at({kSize / 2, 0, 0})}});
  out.arrows.push_back({.name = "contact", .at = {.body = "block", .at = {}}, .vector = {"contact_force", 0, 0}, .frame = "world"});
  out.plots.push_back({.title = "Forces", .unit = "N", .columns = {"force", "contact_force"}});
  out.plots.push_back({.title = "Speeds", .unit = "m/s", .columns = {"finger_rate", "block_rate"}});
  return out;
}

}  // namespace

ControlTask make_task(const toml_file::Document& document) {
  const Table root = document.root({"task", "parameters", "block", "believed"});
  const Table table = required_table(root, "parameters",
                                     {"motion", "speed", "finger_mass", "stiffness", "softness", "slip_speed", "gravity", "noise",
                                      "force_ripple", "friction_ripple", "period", "duration", "window"});
  const Parameters parameters = read_parameters(table);
  const Prior prior = read_prior(root);

  ControlTask task;
  task.period = parameters.period;
  task.duration = positive(table, "duration", 3);
  task.plant = std::make_unique<BlockPlant>(parameters, prior, read_block(root));
  task.estimation = std::make_unique<EstimationProblem>(estimation_problem(parameters, prior, positive_integer(table, "window", 10)));
  task.baselines.push_back({.name = "script", .controller = std::make_unique<PushScript>(parameters, read_path(table))});
  task.scenery = draw();
  return task;
}

}  // namespace tenon::pushed_block
