#include "tenon/problems/touch_down/task.hpp"

#include <cmath>

#include "tenon/problems/toml/checked_keys.hpp"
#include "tenon/problems/touch_down/horizon.hpp"
#include "tenon/problems/touch_down/plane_estimator.hpp"
#include "tenon/problems/touch_down/plant.hpp"
#include "tenon/problems/touch_down/tracking.hpp"

namespace tenon::touch_down {

namespace {

using toml_file::Table;

Parameters read_parameters(const Table& table) {
  Parameters p;
  const std::string contact = table.text("contact", "gap");
  if (contact != "gap" && contact != "pair") throw InputError(table.position("contact"), "unknown contact '" + contact + "'", "gap or pair");
  p.contact = contact == "gap" ? Parameters::Contact::gap : Parameters::Contact::pair;
  p.intervals = positive_integer(table, "intervals", p.intervals);
  p.step = positive(table, "step", p.step);
  p.mass = positive(table, "mass", p.mass);
  p.pole = positive(table, "pole", p.pole);
  return p;
}

World read_world(const Table& table) {
  World world;
  world.mass = positive(table, "mass", world.mass);
  world.stiffness = positive(table, "stiffness", world.stiffness);
  world.damping_ratio = not_negative(table, "damping_ratio", world.damping_ratio);
  world.start = table.number("start", world.start);
  world.plane = table.number("plane", world.plane);
  world.uncertainty = not_negative(table, "uncertainty", world.uncertainty);
  world.wanted_force = positive(table, "force", world.wanted_force);
  world.duration = positive(table, "duration", world.duration);
  if (!(world.start < world.plane - world.uncertainty)) {
    throw InputError(table.position("start"), "the start is not above the nearest plane", "start < plane - uncertainty, z counted downwards");
  }
  return world;
}

/// The sources' pair by the same program, as a baseline.
ControlTask::Baseline pair_baseline(Parameters parameters, const World& world, const PlaneKnowledge& knowledge) {
  parameters.contact = Parameters::Contact::pair;
  ControlTask::Baseline baseline{.name = "pair"};
  baseline.program = std::make_unique<Horizon>(parameters, world.start, knowledge.plane - knowledge.uncertainty);
  baseline.estimator = std::make_unique<PlaneEstimator>(knowledge);
  return baseline;
}

// z downwards; the wrist is a bar whose lower face is at z
Scenery scenery_of(const World& world, const Parameters& horizon) {
  constexpr double kWidth = 0.03, kHeight = 0.006;
  Scenery scenery;
  scenery.up = Eigen::Vector3d(0, -1, 0);
  scenery.extent = 1.6 * (world.plane - world.start);
  SceneryBody plane{.name = "plane", .position = {0, "plane", 0}};
  plane.shapes = {SceneryShape::half_space(Eigen::Vector3d(0, -1, 0)).colored("ground")};
  SceneryBody wrist{.name = "wrist", .position = {0, "z", 0}};
  wrist.shapes = {SceneryShape::box({kWidth, kHeight, 0}).at({0, -kHeight / 2, 0}).colored("link")};
  scenery.bodies = {plane, wrist};
  SceneryBody believed{.name = "believed plane", .position = {0, "plane_believed", 0}, .outline = true};
  believed.shapes = {SceneryShape::line({{-kWidth, 0, 0}, {kWidth, 0, 0}})};
  scenery.bodies.push_back(believed);
  scenery.ghosts = {{.body = "wrist", .count = horizon.intervals, .position = {0, "plan_z#", 0}}};
  scenery.lenses = {{.name = "contact", .body = "plane", .extent = 6e-3}};
  scenery.arrows = {{.name = "contact", .at = {.body = "wrist"}, .vector = {0, SceneryValue("lambda_plane", {0, -1}), 0}, .frame = "world"}};
  const auto plan = [&](const std::string& columns) { return std::vector<SceneryPlot::Foresight>{{columns, horizon.intervals, horizon.step}}; };
  scenery.plots = {{.title = "Contact force and plan", .unit = "N", .columns = {"lambda_plane"}, .foresights = plan("plan_force#")},
                   {.title = "Position and plan; the plane, and where it is believed", .unit = "m",
                    .columns = {"z", "plane", "plane_believed"}, .bands = {{"plane_believed", "cov_plane_believed_plane_believed"}},
                    .foresights = plan("plan_z#")},
                   {.title = "Gap between wrist and plane", .unit = "m", .columns = {"gap_plane"}},
                   {.title = "Command", .unit = "m/s^2", .columns = {"w"}},
                   {.title = "Speed", .unit = "m/s", .columns = {"v"}}};
  return scenery;
}

/// Down, and pressed for a while, onto the plane where it is.
std::unique_ptr<HorizonProgram> whole_touch_down(Parameters parameters, const World& world) {
  constexpr double kTime = 1.2;  // s
  parameters.intervals = static_cast<int>(std::ceil(kTime / parameters.step));
  auto program = std::make_unique<Horizon>(parameters, world.start, world.plane);
  Vector measured = Vector::Zero(program->num_measurements());
  measured[0] = world.start;
  program->observe(0, measured, Eigen::Vector2d(world.plane, world.wanted_force));
  return program;
}

}  // namespace

ControlTask make_task(const toml_file::Document& document) {
  const Table root = document.root({"task", "parameters"});
  const Table table = required_table(root, "parameters",
                                     {"contact", "plane", "uncertainty", "start", "force", "stiffness", "damping_ratio", "mass", "pole", "margin",
                                      "intervals", "step", "period", "duration"});
  const Parameters parameters = read_parameters(table);
  const World world = read_world(table);
  PlaneKnowledge knowledge;
  knowledge.plane = world.plane;
  knowledge.uncertainty = world.uncertainty;
  knowledge.margin = positive(table, "margin", knowledge.margin);
  knowledge.force = world.wanted_force;

  ControlTask task;
  task.period = positive(table, "period", 0.01);
  task.duration = world.duration;
  task.plant = std::make_unique<PlanePlant>(world);
  task.program = std::make_unique<Horizon>(parameters, world.start, knowledge.plane - knowledge.uncertainty);
  task.whole_program = [=] { return whole_touch_down(parameters, world); };
  task.estimator = std::make_unique<PlaneEstimator>(knowledge);
  for (Options* options : task.options.all()) {
    options->tolerance = 1e-4;  // in cm, dm/s, N and N cm: a micrometre, 10 um/s, 0.1 mN
    options->scaling = false;
  }
  task.options.warm.max_iterations = 30;
  task.options.ahead.max_iterations = task.options.cold.max_iterations = 300;
  task.options.largest_violation = 1e-2;
  const TrackingLaw::Settings tracking{.start = world.start, .plane = world.plane, .pole = parameters.pole, .mass = world.mass,
                                       .force = world.wanted_force, .largest_input = parameters.largest_input, .period = task.period};
  task.baselines.push_back({.name = "tracking", .controller = std::make_unique<TrackingLaw>(tracking)});
  task.baselines.push_back(pair_baseline(parameters, world, knowledge));
  task.scenery = scenery_of(world, parameters);
  return task;
}

}  // namespace tenon::touch_down
