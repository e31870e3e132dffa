// The controllers of a task by name: "mpc", its receding horizon where it has one, and its baselines; and its estimator.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tenon/core/control_task.hpp"
#include "tenon/core/solver_factory.hpp"

namespace tenon {

/// Takes the task's estimator out of it, or makes the moving horizon of its estimation problem; null where it has neither.
std::unique_ptr<Estimator> take_estimator(ControlTask& task, const SolverFactory& make_solver);

/// "mpc" where there is a program, then the baselines.
std::vector<std::string> controller_names(const ControlTask& task);

/// Takes the parts of that controller out of the task. Throws std::invalid_argument for a name that is not known, the nearest named, and
/// as RecedingHorizon does.
std::unique_ptr<Controller> take_controller(ControlTask& task, const std::string& name, const SolverFactory& make_solver);

}  // namespace tenon
