// A scene's closed loop as an experiment to repeat, opened by name or file.
#pragma once

#include "tenon/apps/arguments.hpp"
#include "tenon/core/experiment.hpp"
#include "tenon/core/solver_factory.hpp"

namespace tenon {

/// One for each worker: the scene under model-predictive control, with --baselines under each of its baselines too. Reads the scene at once.
/// Throws as the scene's reader does.
ExperimentFactory open_experiment(const Arguments& arguments, const SolverFactory& make_solver);

}  // namespace tenon
