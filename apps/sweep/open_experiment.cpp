#include "tenon/apps/sweep/open_experiment.hpp"

#include <optional>
#include <stdexcept>
#include <utility>

#include "tenon/mpc/closed_loop.hpp"
#include "tenon/mpc/paired_experiments.hpp"
#include "tenon/mpc/task_controllers.hpp"
#include "tenon/problems/tasks.hpp"

namespace tenon {

namespace {

/// Every contestant has a world of its own, drawn from the same seed.
class TaskExperiments {
 public:
  TaskExperiments(const Arguments& arguments, SolverFactory make_solver, PlantOf plant_of)
      : name_(arguments.names.front()),
        overrides_(arguments.set),
        max_iterations_(arguments.max_iterations),
        make_solver_(std::move(make_solver)),
        plant_of_(std::move(plant_of)) {
    const ControlTask task = make_task(name_, overrides_);
    if (!task.program) throw std::invalid_argument(name_ + ": has nothing to sweep, its commands are a script");
    contestants_ = controller_names(task);
    if (!arguments.baselines) contestants_.resize(1);
  }

  std::unique_ptr<Experiment> operator()() const {
    std::vector<PairedExperiments::Named> experiments;
    for (const std::string& contestant : contestants_) experiments.emplace_back(contestant, under(contestant));
    return std::make_unique<PairedExperiments>(std::move(experiments));
  }

 private:
  std::unique_ptr<Experiment> under(const std::string& contestant) const {
    ControlTask task = make_task(name_, overrides_);
    if (max_iterations_) task.options.warm.max_iterations = *max_iterations_;
    std::unique_ptr<Controller> controller = take_controller(task, contestant, make_solver_);
    std::unique_ptr<Plant> plant = plant_of_ ? plant_of_(task) : std::move(task.plant);
    return std::make_unique<ClosedLoopExperiment>(std::move(plant), std::move(controller), task.duration);
  }

  std::string name_;
  std::vector<std::string> overrides_;
  std::optional<int> max_iterations_;
  SolverFactory make_solver_;
  PlantOf plant_of_;
  std::vector<std::string> contestants_;  // the controller first
};

}  // namespace

ExperimentFactory open_experiment(const Arguments& arguments, const SolverFactory& make_solver, const PlantOf& plant_of) {
  return TaskExperiments(arguments, make_solver, plant_of);
}

}  // namespace tenon
