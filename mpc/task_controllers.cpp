#include "tenon/mpc/task_controllers.hpp"

#include <stdexcept>

#include "tenon/core/nearest_name.hpp"
#include "tenon/mpc/moving_horizon.hpp"
#include "tenon/mpc/receding_horizon.hpp"

namespace tenon {

namespace {

const std::string kOwn = "mpc";

}  // namespace

std::unique_ptr<Estimator> take_estimator(ControlTask& task, const SolverFactory& make_solver) {
  if (!task.estimation) return std::move(task.estimator);
  return std::make_unique<MovingHorizon>(std::move(*task.estimation), make_solver);
}

std::vector<std::string> controller_names(const ControlTask& task) {
  std::vector<std::string> names;
  if (task.program) names.push_back(kOwn);
  for (const ControlTask::Baseline& baseline : task.baselines) names.push_back(baseline.name);
  return names;
}

std::unique_ptr<Controller> take_controller(ControlTask& task, const std::string& name, const SolverFactory& make_solver) {
  const auto horizon = [&](std::unique_ptr<HorizonProgram> program, std::unique_ptr<Estimator> estimator) {
    return std::make_unique<RecedingHorizon>(std::move(program), std::move(estimator), make_solver, task.options, task.period);
  };
  if (name == kOwn && task.program) return horizon(std::move(task.program), take_estimator(task, make_solver));
  for (ControlTask::Baseline& baseline : task.baselines) {
    if (baseline.name != name) continue;
    if (baseline.program) return horizon(std::move(baseline.program), std::move(baseline.estimator));
    return std::move(baseline.controller);
  }
  throw std::invalid_argument("unknown controller '" + name + "', the nearest is '" + nearest_name(name, controller_names(task)) + "'");
}

}  // namespace tenon
