// A scene's closed loop as an experiment to repeat, opened by name or file.
#pragma once

#include <functional>
#include <memory>

#include "tenon/apps/arguments.hpp"
#include "tenon/core/control_task.hpp"
#include "tenon/core/experiment.hpp"
#include "tenon/core/solver_factory.hpp"

namespace tenon {

/// How the scene's plant comes to a contestant; null: as the scene has it.
using PlantOf = std::function<std::unique_ptr<Plant>(const ControlTask& task)>;

/// One for each worker: the scene under model-predictive control, with --baselines under each of its baselines too. Reads the scene at once.
/// Throws as the scene's reader does.
ExperimentFactory open_experiment(const Arguments& arguments, const SolverFactory& make_solver, const PlantOf& plant_of = nullptr);

}  // namespace tenon
