// How far a plan is from the solution of its own differential equations, and a mesh on which it is nearer.
//
//     e_k = | X^_{k+1} - X_{k+1} |      X^: the end of a step of order 2 s + 1 from the same X_k with the same inputs  collocation.md (11)
//
// Steps of that order one after the other, from the start on, give the error that all of them have added up to.
#pragma once

#include <vector>

#include "tenon/mpc/collocation.hpp"

namespace tenon {

struct MeshError {
  std::vector<std::vector<double>> steps;  // of each interval of each phase: largest over the states, relative to 1 + their size
  double worst = 0;                        // of them; infinity where a step has no solution
  Vector end;                              // nx: what has added up at the end, absolute
};

/// plan: of ocp's phases, made with `points` points.
MeshError mesh_error(const Ocp& ocp, const Plan& plan, int points);

/// Intervals whose error is above the tolerance, split into as many equal parts as their order asks for, at most 5.
Mesh refined(const Mesh& mesh, const MeshError& error, int points, double tolerance);

}  // namespace tenon
