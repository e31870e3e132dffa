// A plan from an optimal control problem: solve, look at the mesh, refine where it is too coarse, solve again from there.
#pragma once

#include <memory>

#include "tenon/core/solver_factory.hpp"
#include "tenon/mpc/mesh_error.hpp"

namespace tenon {

struct PlannerOptions {
  int points = 3;           // of the Radau method
  double tolerance = 1e-6;  // of a step's error (MeshError::steps)
  int refinements = 4;      // at most; 0: the first mesh as it is
  Options solver = {};
};

struct PlannerOutcome {
  std::unique_ptr<Collocation> program;  // the last one solved,
  Point point;                           // and where that ended
  Result result;
  Plan plan;
  MeshError error;
  int refinements = 0;  // of the mesh
  int iterations = 0;   // of all solves
  double elapsed = 0;   // s, of all solves
};

/// Whatever the status, the plan is that of the last accepted iterate. Throws std::invalid_argument where the problem makes no sense, and
/// as the factory does.
PlannerOutcome make_plan(const Ocp& ocp, const SolverFactory& make_solver, const PlannerOptions& options = {});

}  // namespace tenon
