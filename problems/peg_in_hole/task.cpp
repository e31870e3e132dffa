#include "tenon/problems/peg_in_hole/task.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tenon/problems/delta/robot_file.hpp"
#include "tenon/problems/peg_in_hole/assembly_program.hpp"
#include "tenon/problems/peg_in_hole/baselines.hpp"
#include "tenon/problems/peg_in_hole/channels.hpp"
#include "tenon/problems/peg_in_hole/delta_plant.hpp"
#include "tenon/problems/peg_in_hole/hole_estimator.hpp"
#include "tenon/problems/peg_in_hole/modes.hpp"
#include "tenon/problems/peg_in_hole/plant.hpp"
#include "tenon/problems/peg_in_hole/scenery.hpp"
#include "tenon/problems/toml/checked_keys.hpp"

namespace tenon::peg {

namespace {

using toml_file::Table;

constexpr double kMillimetre = 1e-3;        // m
constexpr double kInnerPeriod = 1e-3;       // s, of the impedance loop
constexpr double kAdmittancePeriod = 2e-3;  // s, at most: at 20 ms it is unstable
constexpr int kColdIterations = 6;

std::optional<Table> plant_table(const Table& root) {
  return root.table("plant", {"mass", "contact_stiffness", "contact_damping_ratio", "encoder_noise", "force_noise", "clearance", "delay",
                              "robot", "peg_mass", "peg_inertia", "unknown_mass"});
}

World read_world(const Table& root, const Table& parameters, const Geometry& believed) {
  World world;
  world.geometry = believed;
  const double lever = believed.lever;
  world.friction = not_negative(parameters, "friction", world.friction);
  const Vector3d offset(parameters.number("offset_x", 0), parameters.number("offset_z", 0), parameters.number("offset_theta", 0));
  world.prior.middle = to_millimetres(offset, lever);
  world.prior.half_width.setZero();
  if (const auto table = root.table("uncertainty", {"x", "z", "theta"})) {
    const Vector3d half(not_negative(*table, "x", 0), not_negative(*table, "z", 0), not_negative(*table, "theta", 0));
    world.prior.half_width = to_millimetres(half, lever);
  }
  if (const auto table = plant_table(root)) {
    world.mass = table->vector3("mass", {0.8, 0.8, 3e-4});
    if (!(world.mass.minCoeff() > 0)) throw InputError(table->position("mass"), "a mass is not positive", "more than 0");
    world.mass[2] /= lever * lever * kMillimetre * kMillimetre;
    world.contact_stiffness = positive(*table, "contact_stiffness", 2e5) * kMillimetre;
    world.contact_damping_ratio = not_negative(*table, "contact_damping_ratio", world.contact_damping_ratio);
    world.encoder_noise = not_negative(*table, "encoder_noise", 5e-6) / kMillimetre;
    world.force_noise = not_negative(*table, "force_noise", world.force_noise);
    world.delay = not_negative(*table, "delay", 0);
    if (table->has("clearance")) world.geometry.clearance = positive(*table, "clearance", 0) / kMillimetre;
  }
  return world;
}

/// The delta that holds the peg, and as it knows itself.
struct Holder {
  delta::Robot robot, believed;
};

/// None: the planar plant's mass and spring.
std::optional<Holder> read_holder(const Table& root, const World& world) {
  const auto table = plant_table(root);
  if (!table || !table->has("robot")) return std::nullopt;
  try {
    delta::Robot robot = delta::load_robot(table->text("robot"));
    robot.payload += not_negative(*table, "peg_mass", 0.3);
    robot.gimbal_inertia[2] += not_negative(*table, "peg_inertia", 1.7e-4);
    Holder holder{robot, robot};
    holder.robot.payload += not_negative(*table, "unknown_mass", 0);
    const DeltaPegPlant trial(world, holder.robot, holder.believed);  // says here, with the place, what a robot lacks
    return holder;
  } catch (const std::invalid_argument& error) {
    throw InputError(table->position("robot"), error.what());
  }
}

std::unique_ptr<Plant> make_plant(const World& world, const std::optional<Holder>& holder) {
  if (holder) return std::make_unique<DeltaPegPlant>(world, holder->robot, holder->believed);
  return std::make_unique<PegPlant>(world);
}

std::optional<Table> horizon_table(const Table& root) {
  return root.table("horizon", {"intervals", "interval", "speed", "smoothing", "complementarity", "delay"});
}

AssemblyProblem read_horizon(const Table& root, const World& world, const Geometry& believed) {
  AssemblyProblem problem;
  problem.geometry = believed;
  problem.pose = world.start;
  problem.depth += world.prior.half_width[1];
  if (const auto table = horizon_table(root)) {
    problem.intervals = positive_integer(*table, "intervals", problem.intervals);
    problem.interval = positive(*table, "interval", problem.interval);
    problem.speed = positive(*table, "speed", 0.025) / kMillimetre;
    problem.smoothing = positive(*table, "smoothing", 2e-5) / kMillimetre;
    problem.complementarity = positive(*table, "complementarity", 1e-5) / kMillimetre;
  }
  return problem;
}

/// Long enough to get to the bottom, into the hole where it is.
AssemblyProblem whole_insertion(AssemblyProblem problem, const World& world) {
  constexpr double kSettling = 0.2;  // s
  problem.hole = world.prior.middle;
  const double way = problem.pose[1] - problem.hole[1] + problem.depth;
  problem.intervals = static_cast<int>(std::ceil((way / problem.speed + kSettling) / problem.interval));
  return problem;
}

}  // namespace

ControlTask make_task(const toml_file::Document& document) {
  const Table root = document.root({"task", "parameters", "uncertainty", "horizon", "plant"});
  const Table parameters = required_table(
      root, "parameters", {"clearance", "friction", "offset_x", "offset_z", "offset_theta", "rate", "iterations", "duration"});
  Geometry believed;
  believed.clearance = positive(parameters, "clearance", 2e-4) / kMillimetre;
  const World world = read_world(root, parameters, believed);
  const std::optional<Holder> holder = read_holder(root, world);
  const AssemblyProblem problem = read_horizon(root, world, believed);
  // What is believed: the hole in the middle of what it was drawn from, without the scene's own offset.
  HoleEstimatorOptions belief{.geometry = believed, .prior = {.half_width = world.prior.half_width}};
  const bool height_is_known = world.prior.half_width[1] == 0;
  belief.cells = height_is_known ? Eigen::Array3i(61, 1, 31) : Eigen::Array3i(61, 13, 21);

  ControlTask task;
  task.period = 1 / positive(parameters, "rate", 50);
  task.duration = positive(parameters, "duration", 5);
  task.plant = make_plant(world, holder);
  task.program = std::make_unique<AssemblyProgram>(problem);
  task.whole_program = [=] { return std::make_unique<AssemblyProgram>(whole_insertion(problem, world)); };
  task.estimator = std::make_unique<HoleEstimator>(belief);
  // The rows are well scaled as they are; a plan that is 0.5 mm or N off still moves the peg the right way.
  for (Options* options : task.options.all()) {
    options->tolerance = 1e-4;
    options->scaling = false;
  }
  task.options.ahead.max_iterations = 100;
  task.options.warm.initial_mu = 1e-4;
  task.options.warm.max_iterations = positive_integer(parameters, "iterations", 1);
  // The initial point is free of the walls, and near enough for a small barrier parameter: a few iterations make a plan of it.
  task.options.cold = task.options.warm;
  task.options.cold.max_iterations = std::max(kColdIterations, task.options.warm.max_iterations);
  task.options.largest_violation = 0.5;
  if (const auto table = horizon_table(root)) task.options.delay = not_negative(*table, "delay", 0);

  const Impedance soft{.stiffness = {0.5, 1, 2.5}};
  task.baselines.push_back({"straight", std::make_unique<StraightDown>(believed, problem.impedance, world.start, problem.depth, task.period)});
  task.baselines.push_back({"soft", std::make_unique<StraightDown>(believed, soft, world.start, problem.depth, task.period)});
  const double fast = std::min(task.period, kAdmittancePeriod);
  task.baselines.push_back({"admittance", std::make_unique<Admittance>(believed, problem.impedance, world.start, problem.depth, fast)});
  task.baselines.push_back({"tilt", std::make_unique<TiltAndSlide>(believed, problem.impedance, world.start, problem.depth, task.period)});
  task.modes = linear_modes(world, problem.impedance, kInnerPeriod, holder ? kInnerPeriod : 0);
  task.capture = {"offset of the hole, m", kMillimetre * 5, [world, holder](double offset) {
                    World beside = world;
                    beside.prior.middle[0] += offset / kMillimetre;
                    beside.prior.half_width[0] = 0;
                    return make_plant(beside, holder);
                  }};
  task.scenery = scenery_of(problem, height_is_known);
  return task;
}

}  // namespace tenon::peg
