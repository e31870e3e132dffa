#include "tenon/problems/delta_payload/task.hpp"

#include <stdexcept>

#include "tenon/problems/delta/robot_file.hpp"
#include "tenon/problems/delta/scene_scenery.hpp"
#include "tenon/problems/delta_payload/plant.hpp"
#include "tenon/problems/toml/checked_keys.hpp"

namespace tenon::delta_payload {

namespace {

using toml_file::Table;

constexpr double kFilterFrequency = 20;  // Hz, of the script's rates

/// The robot's own law, which takes the payload to be the believed one, along a path that is fixed beforehand.
class PathScript final : public Controller {
 public:
  PathScript(const delta::Robot& believed, const delta::ReferencePath& path, double period)
      : law_(believed, {.law = {}, .period = period, .filter_frequency = kFilterFrequency}), path_(path), period_(period) {}

  int num_measurements() const override { return delta::kArms; }
  int num_commands() const override { return delta::kArms; }
  double period() const override { return period_; }
  void reset() override { law_.reset(); }
  void update(double t, ConstVectorRef measurements, VectorRef commands) override {
    law_.set_reference(path_.at(t));
    commands = law_.tick({.angle = measurements}).torque;
  }

 private:
  delta::Controller law_;
  delta::ReferencePath path_;
  double period_;
};

delta::ReferencePath read_path(const Table& table, const delta::Vector3& centre) {
  delta::ReferencePath path;
  path.centre = centre;
  path.radius = positive(table, "radius", 0.06);
  path.frequency = positive(table, "frequency", 0.5);
  const std::string motion = table.text("motion", "circle");
  if (motion != "circle" && motion != "hold")
    throw InputError(table.position("motion"), "unknown motion '" + motion + "'", "circle or hold");
  if (motion == "circle") path.kind = delta::ReferencePath::Kind::circle;
  return path;
}

Parameters read_parameters(const Table& table) {
  Parameters p;
  p.robot = delta::load_robot(table.text("robot", "delta"));
  p.robot.gimbal_inertia.setZero();  // the wrist holds what it carries
  p.centre = table.vector3("centre", p.centre);
  p.noise = positive(table, "noise", p.noise);
  p.torque_ripple = not_negative(table, "torque_ripple", p.torque_ripple);
  p.period = positive(table, "period", p.period);
  return p;
}

}  // namespace

ControlTask make_task(const toml_file::Document& document) {
  const Table root = document.root({"task", "parameters", "carried", "believed"});
  const Table table = required_table(
      root, "parameters", {"robot", "motion", "centre", "radius", "frequency", "noise", "torque_ripple", "period", "duration", "window"});
  const Table carried = required_table(root, "carried", {"payload", "damping"});
  const Table believed = required_table(root, "believed", {"payload", "damping"});
  const Eigen::Vector2d stated(positive(carried, "payload", 0), positive(carried, "damping", 0));
  const Eigen::Vector2d payload = centre_and_deviation(believed, "payload", "median"),
                        damping = centre_and_deviation(believed, "damping", "median");

  ControlTask task;
  try {
    const Parameters parameters = read_parameters(table);
    const Prior known = prior(parameters, payload, damping);
    const delta::Robot robot = robot_with(parameters, payload[0], damping[0]);
    const delta::ReferencePath path = read_path(table, parameters.centre);
    task.period = parameters.period;
    task.duration = positive(table, "duration", 4);
    task.plant = std::make_unique<PayloadPlant>(parameters, known, stated);
    task.estimation = std::make_unique<EstimationProblem>(estimation_problem(parameters, known, positive_integer(table, "window", 10)));
    task.baselines.push_back({.name = "script", .controller = std::make_unique<PathScript>(robot, path, task.period)});
    delta::Scene scene;
    scene.robot = robot;
    scene.position = parameters.centre;
    scene.reference = path;
    task.scenery = delta::scene_scenery(scene);
    task.scenery.plots = {{.title = "Motor torques", .unit = "N m", .columns = {"torque1", "torque2", "torque3"}},
                          {.title = "Motor rates", .unit = "rad/s", .columns = {"v11", "v21", "v31"}}};
  } catch (const std::invalid_argument& error) {
    throw InputError(table.position("robot"), error.what());
  }
  return task;
}

}  // namespace tenon::delta_payload
