// The parts of `tenon compare` that the problems of a catalogue and the rows of a vehicle share.
#pragma once

#include <string>
#include <vector>

#include "tenon/apps/arguments.hpp"
#include "tenon/solvers/make_solver.hpp"

namespace tenon {

/// The back ends to compare: those of --solvers, else every one that is available. Throws std::invalid_argument for one that is not known
/// or not available.
std::vector<SolverDescription> chosen_solvers(const Arguments& arguments);

/// `tenon compare VEHICLE --rows N --seed S`: random rows of an allocation on every back end. Returns an ExitCode.
int compare_vehicle(const std::string& vehicle, const Arguments& arguments);

}  // namespace tenon
