// In place of ipopt.cpp where Ipopt was absent at the time of the build, or not wanted.
#include <stdexcept>

#include "tenon/solvers/ipopt.hpp"

namespace tenon {

SolverDescription describe_ipopt() { return {"ipopt", "interior point with a line search filter, Ipopt", false, ""}; }

std::unique_ptr<Solver> make_ipopt(const Nlp&, const Options&) {
  throw std::invalid_argument("solver \"ipopt\" is not available: Ipopt was absent when tenon was built");
}

}  // namespace tenon
