// How a solver comes to those who may not know its name: a controller is given one of these.
#pragma once

#include <functional>
#include <memory>

#include "tenon/core/nlp.hpp"
#include "tenon/core/options.hpp"
#include "tenon/core/solver.hpp"

namespace tenon {

/// A solver of the problem, which must live as long.
using SolverFactory = std::function<std::unique_ptr<Solver>(const Nlp& problem, const Options& options)>;

}  // namespace tenon
