#include "tenon/apps/sweep/open_experiment.hpp"

#include <memory>
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
  TaskExperiments(const Arguments& arguments, SolverFactory make_solver)
      : name_(arguments.names.front()),
        overrides_(arguments.set),
        max_iterations_(arguments.max_iterations),
        with_baselines_(arguments.baselines),
        make_solver_(std::move(make_solver)) {
    make_task(name_, overrides_);
  }

  std::unique_ptr<Experiment> operator()() const {
    std::vector<std::string> names = controller_names(make_task(name_, overrides_));
    if (!with_baselines_) names.resize(1);
    std::vector<PairedExperiments::Named> contestants;
    for (const std::string& name : names) contestants.emplace_back(name, under(name));
    return std::make_unique<PairedExperiments>(std::move(contestants));
  }

 private:
  std::unique_ptr<Experiment> under(const std::string& controller_name) const {
    ControlTask task = make_task(name_, overrides_);
    if (max_iterations_) task.options.warm.max_iterations = *max_iterations_;
    auto controller = take_controller(task, controller_name, make_solver_);
    return std::make_unique<ClosedLoopExperiment>(std::move(task.plant), std::move(controller), task.duration);
  }

  std::string name_;
  std::vector<std::string> overrides_;
  std::optional<int> max_iterations_;
  bool with_baselines_;
  SolverFactory make_solver_;
};

}  // namespace

ExperimentFactory open_experiment(const Arguments& arguments, const SolverFactory& make_solver) {
  return TaskExperiments(arguments, make_solver);
}

}  // namespace tenon
