// Every back end by name, behind one face.
//
// To add one: write one .cpp over `const Nlp&` (solvers/ipopt.cpp is the pattern), give it a line in make_solver.cpp; where its library may
// be absent, CMake picks a no_<library>.cpp in its place.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tenon/core/solver.hpp"

namespace tenon {

struct SolverDescription {
  std::string name;         // as on the command line
  std::string description;  // one line: method, library and its version
  bool available = false;   // false: its library was absent when this was built
  std::string options;      // what the adapter sets beside tolerance and limits, for the record of a comparison
};

/// Every back end this project knows, available or not, in the order in which comparisons list them.
std::vector<SolverDescription> list_solvers();

/// A solver for `problem`, which must outlive it. The constructor allocates what a solve needs. Soft rows, and for some back ends compliant
/// ones, get slacks on the way; the answer is that of the problem itself, its objective without the price of the slacks.
/// Throws std::invalid_argument for an unknown name (the nearest is named), for a back end that is not available, for options
/// that make no sense, and for a problem that the back end cannot take (what it lacks is said).
std::unique_ptr<Solver> make_solver(const std::string& name, const Nlp& problem, const Options& options = {});

}  // namespace tenon
