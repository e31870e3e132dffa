// Four local methods of NLopt behind the solver contract [S. G. Johnson, The NLopt nonlinear-optimization package]. Where the library is
// absent, no_nlopt.cpp answers instead.
#pragma once

#include "tenon/solvers/make_solver.hpp"

namespace tenon {

SolverDescription describe_nlopt_slsqp();
SolverDescription describe_nlopt_mma();
SolverDescription describe_nlopt_ccsaq();
SolverDescription describe_nlopt_auglag();

/// `problem` must outlive the solver. Each throws std::invalid_argument for options that make no sense, and where NLopt is not available;
/// MMA and CCSAQ also where the problem has equality rows.
std::unique_ptr<Solver> make_nlopt_slsqp(const Nlp& problem, const Options& options);
std::unique_ptr<Solver> make_nlopt_mma(const Nlp& problem, const Options& options);
std::unique_ptr<Solver> make_nlopt_ccsaq(const Nlp& problem, const Options& options);
std::unique_ptr<Solver> make_nlopt_auglag(const Nlp& problem, const Options& options);

}  // namespace tenon
