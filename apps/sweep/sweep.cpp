// tenon sweep in one process, on any back end.
#include "tenon/apps/default_solver.hpp"
#include "tenon/apps/sweep/run_sweep.hpp"
#include "tenon/solvers/make_solver.hpp"

namespace tenon {

int run_sweep(const Arguments& arguments) {
  Crew alone;
  const std::string solver = arguments.solver.value_or(default_solver());
  return sweep(arguments, alone, [solver](const Nlp& problem, const Options& options) { return make_solver(solver, problem, options); });
}

}  // namespace tenon
