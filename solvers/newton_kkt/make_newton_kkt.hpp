// Newton-KKT for any Nlp, behind the face that all back ends share.
#pragma once

#include <memory>

#include "tenon/core/solver.hpp"
#include "tenon/solvers/make_solver.hpp"

namespace tenon {

/// The instance of NewtonKkt for problems that declare stages, or the sparse one. Throws std::invalid_argument for options, bounds or stages
/// that make no sense.
std::unique_ptr<Solver> make_newton_kkt(const Nlp& problem, const Options& options);

SolverDescription describe_newton_kkt();

}  // namespace tenon
