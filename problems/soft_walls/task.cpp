#include "tenon/problems/soft_walls/task.hpp"

#include <cmath>

#include "tenon/problems/soft_walls/plant.hpp"
#include "tenon/problems/toml/checked_keys.hpp"

namespace tenon::soft_walls {

namespace {

using toml_file::Table;

/// The law of the terminal cost alone: it knows nothing of walls.
class LinearQuadraticRegulator final : public Controller {
 public:
  LinearQuadraticRegulator(const Model& model, const Weights& weights)
      : gain_(regulator_gain(model, weights, riccati_solution(model, weights))), period_(model.parameters().step) {}

  int num_measurements() const override { return 4; }
  int num_commands() const override { return 1; }
  double period() const override { return period_; }
  void reset() override {}
  void update(double, ConstVectorRef measurements, VectorRef commands) override { commands[0] = -gain_.dot(measurements); }

 private:
  Eigen::RowVector4d gain_;
  double period_;
};

State state_of(const Table& table, const std::string& key) {
  return State(table.numbers(key, 4).data());
}

Parameters read_parameters(const Table& table) {
  Parameters p;
  p.pole_mass = positive(table, "pole_mass", p.pole_mass);
  p.cart_mass = positive(table, "cart_mass", p.cart_mass);
  p.pole_length = positive(table, "pole_length", p.pole_length);
  p.com_length = positive(table, "com_length", p.com_length);
  p.wall = positive(table, "wall", p.wall);
  p.stiffness = positive(table, "stiffness", p.stiffness);
  p.gravity = positive(table, "gravity", p.gravity);
  p.step = positive(table, "step", p.step);
  return p;
}

Weights read_weights(const Table& root) {
  Weights weights;
  if (const auto table = root.table("weights", {"state", "input"})) {
    if (table->has("state")) weights.state = state_of(*table, "state");
    if (!(weights.state.minCoeff() > 0)) throw InputError(table->position("state"), "a weight of the state is not positive", "more than 0");
    weights.input = positive(*table, "input", weights.input);
  }
  return weights;
}

/// The wall's face, and the pole on its cart.
Scenery scenery_of(const Parameters& p, int intervals) {
  constexpr double kCartHeight = 0.08, kThin = 0.012;
  Scenery scenery;
  scenery.extent = 2.6 * p.wall;
  scenery.camera_target = Eigen::Vector3d(0, p.pole_length / 2, 0);
  SceneryBody walls{.name = "walls"};
  for (const double side : {1.0, -1.0})
    walls.shapes.push_back(SceneryShape::half_space(Eigen::Vector3d(-side, 0, 0), Eigen::Vector3d(side * p.wall, 0, 0)).colored("ground"));
  SceneryBody cart{.name = "cart", .position = {"x", 0, 0}};
  cart.shapes = {SceneryShape::box({0.16, kCartHeight, 0}).colored("frame")};
  // the angle is positive where the tip is to the left: tip = x - length theta
  SceneryBody pole{.name = "pole", .parent = "cart", .angle = SceneryValue("theta")};
  pole.shapes = {SceneryShape::capsule(Eigen::Vector3d::Zero(), Eigen::Vector3d(0, p.pole_length, 0), kThin).colored("link")};
  scenery.bodies = {walls, cart, pole};
  const SceneryPoint tip{.body = "pole", .at = {0, p.pole_length, 0}};
  scenery.arrows = {{.name = "right wall", .at = tip, .vector = {SceneryValue("lambda_right", {0, -1}), 0, 0}, .frame = "world"},
                    {.name = "left wall", .at = tip, .vector = {"lambda_left", 0, 0}, .frame = "world"}};
  scenery.ghosts = {{.body = "pole", .count = intervals, .position = {"plan_x#", 0, 0}, .angle = SceneryValue("plan_theta#")}};
  scenery.plots = {{.title = "Tip between the walls, and the plan", .unit = "m", .columns = {"tip"},
                    .lower = -p.wall, .upper = p.wall, .foresights = {{"plan_tip#", intervals, p.step}}},
                   {.title = "Cart, and the plan", .unit = "m", .columns = {"x"}, .foresights = {{"plan_x#", intervals, p.step}}},
                   {.title = "Walls' forces", .unit = "N", .columns = {"lambda_right", "lambda_left"}},
                   {.title = "Force on the cart", .unit = "N", .columns = {"u"}}};
  return scenery;
}

}  // namespace

ControlTask make_task(const toml_file::Document& document) {
  const Table root = document.root({"task", "parameters", "weights", "start", "uncertainty"});
  const Table parameters = required_table(root, "parameters",
                                          {"intervals", "step", "duration", "wall", "stiffness", "rounding", "pole_mass", "cart_mass",
                                           "pole_length", "com_length", "gravity"});
  const Model model(read_parameters(parameters));
  const Weights weights = read_weights(root);
  const State start = state_of(required_table(root, "start", {"state"}), "state");
  const auto uncertainty = root.table("uncertainty", {"start"});
  const State spread = uncertainty ? state_of(*uncertainty, "start") : State(State::Zero());

  ControlTask task;
  task.period = model.parameters().step;
  task.duration = positive(parameters, "duration", 6);
  task.plant = std::make_unique<WallsPlant>(model, weights, start, spread);
  const int intervals = positive_integer(parameters, "intervals", 10), all = static_cast<int>(std::ceil(task.duration / task.period));
  const double rounding = positive(parameters, "rounding", 2e-3);
  task.program = std::make_unique<Horizon>(model, weights, intervals, rounding, start);
  task.whole_program = [=] { return std::make_unique<Horizon>(model, weights, all, rounding, start); };
  // No inequality stands in this program: each iteration is a Newton step, and the rows are well scaled as they are.
  for (Options* options : task.options.all()) {
    options->tolerance = 1e-6;
    options->scaling = false;
  }
  task.options.warm.max_iterations = 20;
  task.options.ahead.max_iterations = task.options.cold.max_iterations = 100;
  task.baselines.push_back({.name = "lqr", .controller = std::make_unique<LinearQuadraticRegulator>(model, weights)});
  task.scenery = scenery_of(model.parameters(), intervals);
  return task;
}

}  // namespace tenon::soft_walls
