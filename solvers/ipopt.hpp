// Ipopt behind the solver contract [Waechter & Biegler 2006]. Where the library is absent, no_ipopt.cpp answers instead.
#pragma once

#include "tenon/solvers/make_solver.hpp"

namespace tenon {

SolverDescription describe_ipopt();

/// `problem` must outlive the solver. Throws std::invalid_argument for options that make no sense, and where Ipopt is not available.
std::unique_ptr<Solver> make_ipopt(const Nlp& problem, const Options& options);

}  // namespace tenon
