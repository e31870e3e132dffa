#include "tenon/solvers/newton_kkt/make_newton_kkt.hpp"

#include "tenon/solvers/newton_kkt/newton_kkt.hpp"

namespace tenon {

namespace {

template <class Kkt>
class NlpNewtonKkt final : public Solver {
 public:
  NlpNewtonKkt(const Nlp& problem, const Options& options)
      : problem_(problem), bounds_(problem.num_variables(), problem.num_constraints()), solver_(problem, options) {}

  Result solve(Point& point) override {
    validate(problem_, point);
    problem_.bounds(bounds_);
    validate(problem_, bounds_);
    return solver_.solve(point);
  }

 private:
  const Nlp& problem_;
  Bounds bounds_;
  NewtonKkt<Nlp, Kkt> solver_;
};

}  // namespace

std::unique_ptr<Solver> make_newton_kkt(const Nlp& problem, const Options& options) {
  validate(options);
  if (problem.stages().empty()) return std::make_unique<NlpNewtonKkt<SparseKkt>>(problem, options);
  return std::make_unique<NlpNewtonKkt<StageKkt<>>>(problem, options);
}

SolverDescription describe_newton_kkt() {
  return {"newton-kkt", "primal-dual interior point with filter line search, tenon's own", true,
          "exact Hessian; stage-structured or multifrontal LDL'"};
}

}  // namespace tenon
