// CountedNlp, Counted<P>: the same problem, with a count of what was evaluated. Decorators, so that no solver counts.
#pragma once

#include "tenon/core/nlp.hpp"

namespace tenon {

struct EvaluationCounts {
  long prepare = 0;  // distinct points visited
  long objective = 0;
  long gradient = 0;
  long constraints = 0;
  long jacobian = 0;
  long hessian = 0;

  bool operator==(const EvaluationCounts&) const = default;
};

/// Refers to the problem and to the counts, which must outlive this; counts are the caller's to reset.
class CountedNlp final : public Nlp {
 public:
  CountedNlp(const Nlp& problem, EvaluationCounts& counts) : problem_(problem), counts_(counts) {}

  int num_variables() const override { return problem_.num_variables(); }
  int num_constraints() const override { return problem_.num_constraints(); }
  SparsePattern jacobian_pattern() const override { return problem_.jacobian_pattern(); }
  SparsePattern hessian_pattern() const override { return problem_.hessian_pattern(); }
  Stages stages() const override { return problem_.stages(); }
  void bounds(Bounds& bounds) const override { problem_.bounds(bounds); }
  void initial_point(VectorRef x) const override { problem_.initial_point(x); }
  Workspace make_workspace() const override { return problem_.make_workspace(); }
  std::string name() const override { return problem_.name(); }
  std::string variable_name(int i) const override { return problem_.variable_name(i); }
  std::string constraint_name(int j) const override { return problem_.constraint_name(j); }

  void prepare(ConstVectorRef x, Workspace& workspace) const override {
    ++counts_.prepare;
    problem_.prepare(x, workspace);
  }
  double objective(ConstVectorRef x, Workspace& workspace) const override {
    ++counts_.objective;
    return problem_.objective(x, workspace);
  }
  void gradient(ConstVectorRef x, Workspace& workspace, VectorRef gradient) const override {
    ++counts_.gradient;
    problem_.gradient(x, workspace, gradient);
  }
  void constraints(ConstVectorRef x, Workspace& workspace, VectorRef values) const override {
    ++counts_.constraints;
    problem_.constraints(x, workspace, values);
  }
  void jacobian(ConstVectorRef x, Workspace& workspace, std::span<double> values) const override {
    ++counts_.jacobian;
    problem_.jacobian(x, workspace, values);
  }
  void hessian(ConstVectorRef x, double sigma, ConstVectorRef lambda, Workspace& workspace,
               std::span<double> values) const override {
    ++counts_.hessian;
    problem_.hessian(x, sigma, lambda, workspace, values);
  }

 private:
  const Nlp& problem_;
  EvaluationCounts& counts_;
};

/// The same for a problem of fixed size. Counts nothing where `counts` is null, so that one solver serves for counting and for the clock.
template <NonlinearProgram P>
  requires kFixedSize<P>
class Counted {
 public:
  using Scalar = typename P::Scalar;
  using Workspace = WorkspaceOf<P>;
  using Hessian = HessianOf<P>;
  static constexpr int kVariables = P::kVariables;
  static constexpr int kConstraints = P::kConstraints;

  explicit Counted(const P& problem, EvaluationCounts* counts = nullptr) : problem_(problem), counts_(counts) {}
  void count_into(EvaluationCounts* counts) { counts_ = counts; }

  constexpr int num_variables() const { return kVariables; }
  constexpr int num_constraints() const { return kConstraints; }
  Workspace make_workspace() const { return problem_.make_workspace(); }
  void bounds(BoundsOf<P>& bounds) const { problem_.bounds(bounds); }

  void prepare(const VectorNOf<P>& x, Workspace& at) const {
    if (counts_) ++counts_->prepare;
    problem_.prepare(x, at);
  }
  Scalar objective(const VectorNOf<P>& x, Workspace& at) const {
    if (counts_) ++counts_->objective;
    return problem_.objective(x, at);
  }
  void gradient(const VectorNOf<P>& x, Workspace& at, VectorNOf<P>& gradient) const {
    if (counts_) ++counts_->gradient;
    problem_.gradient(x, at, gradient);
  }
  void constraints(const VectorNOf<P>& x, Workspace& at, VectorMOf<P>& values) const {
    if (counts_) ++counts_->constraints;
    problem_.constraints(x, at, values);
  }
  void jacobian(const VectorNOf<P>& x, Workspace& at, JacobianOf<P>& jacobian) const {
    if (counts_) ++counts_->jacobian;
    problem_.jacobian(x, at, jacobian);
  }
  void hessian(const VectorNOf<P>& x, Scalar sigma, const VectorMOf<P>& lambda, Workspace& at, Hessian& hessian) const {
    if (counts_) ++counts_->hessian;
    problem_.hessian(x, sigma, lambda, at, hessian);
  }

 private:
  const P& problem_;
  EvaluationCounts* counts_;
};

}  // namespace tenon
