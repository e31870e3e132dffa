// tenon sweep SCENE --margins: how much a scene bears before it fails, beside how often it does.
//
// Of each mode's linear loop the margins of stability (mpc/mode_margins.hpp); of the whole, the largest offset, to either side, at which every
// one of N worlds is still a success: nonlinear, with estimator and horizon, by bisection.
#pragma once

#include "tenon/apps/arguments.hpp"
#include "tenon/core/solver_factory.hpp"

namespace tenon {

/// Throws std::invalid_argument where the scene has no modes.
int run_margins(const Arguments& arguments, const SolverFactory& make_solver);

}  // namespace tenon
