// Feasibility restoration: where the line search finds nothing, look for a point that violates the rows less, and go on from there.
//
// The same loop solves the feasibility problem (feasibility_problem.hpp), with a proximal weight zeta that shrinks: if it ends before the
// point is good enough for the filter, and the proximal term no longer holds it back, the violation is as small as it gets nearby, and the
// problem is locally infeasible.
#pragma once

#include <algorithm>

#include "tenon/solvers/newton_kkt/feasibility_problem.hpp"
#include "tenon/solvers/newton_kkt/newton_kkt.hpp"

namespace tenon {

template <NonlinearProgram P, class Kkt>
class Restoration {
 public:
  using Scalar = typename P::Scalar;

  Restoration(const P& problem, const Options& options)
      : feasibility_(problem), solver_(feasibility_, inner_options(options)), point_(problem.num_variables(), problem.num_constraints()) {}

  int iterations() const { return iterations_; }
  const VectorNOf<P>& x() const { return point_.x; }

  /// From x, with a barrier parameter of about mu. `enough(x)` is asked at each iterate: restored when it says yes. `violation(x)` is the
  /// largest violation of a hard row.
  /// Ends with: nullopt (x() is a better point), infeasible, or why it could not go on.
  template <class Violation, class Enough>
  std::optional<Status> restore(const VectorNOf<P>& x, Scalar mu, int max_iterations, double time_limit,
                                Violation&& violation, Enough&& enough) {
    iterations_ = 0;
    point_.x = x;
    Scalar zeta = kFirstZeta;
    for (int round = 0; round < kMaxRounds; ++round, zeta *= kZetaFall) {
      feasibility_.set_reference(point_.x, zeta);
      point_.lambda.setZero();
      point_.z.setZero();
      solver_.options().initial_mu = double(std::clamp(mu, Scalar(1e-6), Scalar(1e3)));
      solver_.options().max_iterations = max_iterations - iterations_;
      solver_.options().time_limit = time_limit;
      const Result result = solver_.solve(point_, [&](const auto& iterate) { return enough(iterate.x); });
      iterations_ += result.iterations;
      if (result.status == Status::stopped) return std::nullopt;
      if (result.status == Status::iteration_limit || result.status == Status::time_limit) return result.status;
      if (!succeeded(result.status)) return Status::numerical_failure;

      // converged: what is left, against zeta W^2 (x - x_R), the force with which the proximal term still holds x back
      const Scalar left = violation(point_.x);
      if (left <= Scalar(kAcceptableFactor * solver_.options().tolerance)) return std::nullopt;
      if (feasibility_.pull(point_.x) <= kFaintPull * left) return Status::infeasible;
    }
    return Status::infeasible;
  }

 private:
  static Options inner_options(Options options) {
    options.on_iteration = nullptr;
    options.warm_start = true;
    return options;
  }

  static constexpr Scalar kFirstZeta = Scalar(1e-3), kZetaFall = Scalar(0.01), kFaintPull = Scalar(1e-6);
  static constexpr int kMaxRounds = 5;

  FeasibilityProblem<P> feasibility_;
  NewtonKkt<FeasibilityProblem<P>, Kkt, NoRestoration> solver_;  // the patterns, and so the linear algebra, are those of the problem
  PointOf<FeasibilityProblem<P>> point_;
  int iterations_ = 0;
};

}  // namespace tenon
