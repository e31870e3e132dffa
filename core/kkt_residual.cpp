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
  const Vector stationarity = gradient + point.z + jacobian.transpose() * point.lambda;
  const Vector rows = constraints - bounds.compliance.cwiseProduct(point.lambda - bounds.preload);
  return kkt_residual(point, bounds, stationarity, rows);
}

}  // namespace tenon
