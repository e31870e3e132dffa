// Which back end solves where none is named.
#pragma once

#include <stdexcept>
#include <string>

#include "tenon/solvers/make_solver.hpp"

namespace tenon {

/// The first that is there: tenon's own comes first in the list.
inline std::string default_solver() {
  for (const SolverDescription& s : list_solvers()) {
    if (s.available) return s.name;
  }
  throw std::invalid_argument("no solver is available (expected a build with at least one back end)");
}

}  // namespace tenon
