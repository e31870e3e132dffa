#include "tenon/core/kkt_residual.hpp"

namespace tenon {

KktResidual kkt_residual(const Nlp& problem, const Point& point) {
  const int n = problem.num_variables(), m = problem.num_constraints();
  Bounds bounds(n, m);
  problem.bounds(bounds);

  Nlp::Workspace workspace = problem.make_workspace();
  problem.prepare(point.x, workspace);
  Vector gradient(n), constraints(m);
  SparseMatrix jacobian = problem.jacobian_pattern().zero_matrix();
  problem.gradient(point.x, workspace, gradient);
  problem.constraints(point.x, workspace, constraints);
  problem.jacobian(point.x, workspace, values_of(jacobian));
  return kkt_residual(point, bounds, gradient, constraints, jacobian);
}

}  // namespace tenon
