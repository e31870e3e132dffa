// One problem, from its own start, by a back end named.
#pragma once

#include <string>

#include "tenon/solvers/make_solver.hpp"

namespace tenon {

struct Solved {
  Point point;
  Result result;
};

inline Solved solve(const Nlp& problem, const std::string& solver, const Options& options = {}) {
  Solved out{Point(problem.num_variables(), problem.num_constraints()), {}};
  problem.initial_point(out.point.x);
  out.result = make_solver(solver, problem, options)->solve(out.point);
  return out;
}

inline Solved solve(const Nlp& problem, const Options& options = {}) {
  return solve(problem, "newton-kkt", options);
}

}  // namespace tenon
