// What the adapters of foreign libraries share: evaluation at the x a library happens to ask for, and the verdict of the ruler.
#pragma once

#include <cmath>
#include <span>
#include <stdexcept>

#include "tenon/core/solver.hpp"

namespace tenon {

/// Calls prepare() once for each new x, in whatever order a library asks. It compares x itself, because a library's own word on whether
/// x is new (Ipopt's new_x) tells of its caches, not of ours.
class PreparedNlp {
 public:
  explicit PreparedNlp(const Nlp& problem) : problem_(problem), workspace_(problem.make_workspace()) {}

  /// Forgets the last x: between two solves the problem may have been changed by its setters.
  void reset() { x_.resize(0); }

  double objective(ConstVectorRef x) { return visit(x), problem_.objective(x_, workspace_); }
  void gradient(ConstVectorRef x, VectorRef gradient) { visit(x), problem_.gradient(x_, workspace_, gradient); }
  void constraints(ConstVectorRef x, VectorRef values) { visit(x), problem_.constraints(x_, workspace_, values); }
  void jacobian(ConstVectorRef x, std::span<double> values) { visit(x), problem_.jacobian(x_, workspace_, values); }
  void hessian(ConstVectorRef x, double sigma, ConstVectorRef lambda, std::span<double> values) {
    visit(x), problem_.hessian(x_, sigma, lambda, workspace_, values);
  }

 private:
  void visit(ConstVectorRef x) {
    if (x_.size() == x.size() && x_ == x) return;
    x_ = x;
    problem_.prepare(x_, workspace_);
  }

  const Nlp& problem_;
  Nlp::Workspace workspace_;
  Vector x_;
};

/// The bounds as they stand now, validated. Throws std::invalid_argument where a row is compliant or soft: these libraries take hard rows only
/// (make_solver gives each compliant row a slack, core/with_slacks.hpp).
inline Bounds hard_bounds(const Nlp& problem, const char* library) {
  Bounds bounds(problem.num_variables(), problem.num_constraints());
  problem.bounds(bounds);
  validate(problem, bounds);
  refuse_soft_rows(problem);
  for (int j = 0; j < problem.num_constraints(); ++j) {
    if (bounds.compliance[j] > 0) {
      throw std::invalid_argument("row " + problem.constraint_name(j) + " of " + problem.name() + " is compliant, and " + library +
                                  " takes hard rows only (wrap the problem in WithSlacks before the solver is made)");
    }
  }
  return bounds;
}

/// The status of a library's stop that claims nothing sharper than "no further progress": by the ruler alone.
inline Status judged(const KktResidual& residual, double tolerance) {
  if (residual.max_scaled() <= tolerance) return Status::solved;
  if (residual.max_scaled() <= kAcceptableFactor * tolerance) return Status::acceptable;
  return Status::numerical_failure;
}

}  // namespace tenon
