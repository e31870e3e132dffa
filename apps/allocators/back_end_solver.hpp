// Any back end in the place of a fixed-size solver: the problem is lifted to an Nlp, points are copied to and fro.
#pragma once

#include <memory>
#include <string>

#include "tenon/core/as_nlp.hpp"
#include "tenon/core/point.hpp"
#include "tenon/core/with_slacks.hpp"
#include "tenon/solvers/make_solver.hpp"

namespace tenon {

template <class P>
class BackEndSolver {
 public:
  /// `problem` must outlive this. Throws as make_solver() does.
  BackEndSolver(const P& problem, const std::string& name, const Options& options)
      : problem_(&problem),
        name_(name),
        options_(options),
        lifted_(std::make_unique<AsNlp<P>>(problem)),
        solver_(make_solver(name, *lifted_, options)),
        point_(P::kVariables, P::kConstraints) {}

  Result solve(PointOf<P>& point) {
    // A back end that knows hard rows only has slacks for the rows that were compliant when it was made.
    if (!compliant_ && has_compliant_rows(*lifted_)) {
      solver_ = make_solver(name_, *lifted_, options_);
      compliant_ = true;
    }
    point_.x = point.x;
    point_.lambda = point.lambda;
    point_.z = point.z;
    const Result result = solver_->solve(point_);
    point.x = point_.x;
    point.lambda = point_.lambda;
    point.z = point_.z;
    WorkspaceOf<P> workspace = problem_->make_workspace();
    problem_->prepare(point.x, workspace);
    problem_->constraints(point.x, workspace, constraints_);
    return result;
  }

  /// c(x) at the point that the last solve returned.
  const VectorMOf<P>& constraints() const { return constraints_; }

 private:
  const P* problem_;
  std::string name_;
  Options options_;
  bool compliant_ = false;
  VectorMOf<P> constraints_;
  std::unique_ptr<AsNlp<P>> lifted_;  // at an address that stays when this moves
  std::unique_ptr<Solver> solver_;
  Point point_;
};

}  // namespace tenon
