#include "tenon/mpc/planner.hpp"

#include <utility>

namespace tenon {

namespace {
// A plan on a coarser mesh is near the answer, but has no multipliers for the finer one: they begin as mu over the distance of each bound.
constexpr double kWarmMu = 1e-3;
}  // namespace

PlannerOutcome make_plan(const Ocp& ocp, const SolverFactory& make_solver, const PlannerOptions& options) {
  PlannerOutcome out;
  Mesh mesh = uniform_mesh(ocp);
  for (;; ++out.refinements) {
    auto program = std::make_unique<Collocation>(ocp, options.points, std::move(mesh));
    Point point(program->num_variables(), program->num_constraints());
    if (out.refinements == 0)
      program->initial_point(point.x);
    else
      program->point_of(out.plan, point.x);
    Options of_solver = options.solver;
    if (out.refinements > 0) of_solver.warm_start = true, of_solver.initial_mu = kWarmMu;
    out.result = make_solver(*program, of_solver)->solve(point);
    out.iterations += out.result.iterations;
    out.elapsed += out.result.elapsed;
    out.program = std::move(program);
    out.point = std::move(point);
    out.plan = out.program->plan(out.point.x);
    out.error = mesh_error(ocp, out.plan, options.points);
    if (!succeeded(out.result.status) || out.error.worst <= options.tolerance || out.refinements == options.refinements) return out;
    mesh = refined(out.program->mesh(), out.error, options.points, options.tolerance);
  }
}

}  // namespace tenon
