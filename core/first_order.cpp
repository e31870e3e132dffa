#include "tenon/core/first_order.hpp"

#include <cmath>

namespace tenon {

FirstOrder::FirstOrder(const Nlp& problem, const Vector& x)
    : gradient(problem.num_variables()), constraints(problem.num_constraints()), jacobian(problem.jacobian_pattern().zero_matrix()) {
  Nlp::Workspace workspace = problem.make_workspace();
  problem.prepare(x, workspace);
  objective = problem.objective(x, workspace);
  problem.gradient(x, workspace, gradient);
  problem.constraints(x, workspace, constraints);
  problem.jacobian(x, workspace, values_of(jacobian));
}

bool FirstOrder::all_finite() const {
  return std::isfinite(objective) && gradient.allFinite() && constraints.allFinite() && jacobian.coeffs().allFinite();
}

}  // namespace tenon
