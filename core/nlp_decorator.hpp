// NlpDecorator: a problem that is another one, all but what a derived class says anew.
#pragma once

#include "tenon/core/nlp.hpp"

namespace tenon {

/// Refers to the problem, which must outlive this.
class NlpDecorator : public Nlp {
 public:
  explicit NlpDecorator(const Nlp& problem) : problem_(problem) {}

  int num_variables() const override { return problem_.num_variables(); }
  int num_constraints() const override { return problem_.num_constraints(); }
  SparsePattern jacobian_pattern() const override { return problem_.jacobian_pattern(); }
  SparsePattern hessian_pattern() const override { return problem_.hessian_pattern(); }
  Stages stages() const override { return problem_.stages(); }
  void bounds(Bounds& bounds) const override { problem_.bounds(bounds); }
  std::vector<SoftRow> soft_rows() const override { return problem_.soft_rows(); }
  void nominal_values(VectorRef variables, VectorRef rows) const override { problem_.nominal_values(variables, rows); }
  HessianKind hessian_kind() const override { return problem_.hessian_kind(); }
  void initial_point(VectorRef x) const override { problem_.initial_point(x); }
  Workspace make_workspace() const override { return problem_.make_workspace(); }
  void prepare(ConstVectorRef x, Workspace& workspace) const override { problem_.prepare(x, workspace); }
  double objective(ConstVectorRef x, Workspace& workspace) const override { return problem_.objective(x, workspace); }
  void gradient(ConstVectorRef x, Workspace& workspace, VectorRef gradient) const override { problem_.gradient(x, workspace, gradient); }
  void constraints(ConstVectorRef x, Workspace& workspace, VectorRef values) const override { problem_.constraints(x, workspace, values); }
  void jacobian(ConstVectorRef x, Workspace& workspace, std::span<double> values) const override {
    problem_.jacobian(x, workspace, values);
  }
  void hessian(ConstVectorRef x, double sigma, ConstVectorRef lambda, Workspace& workspace, std::span<double> values) const override {
    problem_.hessian(x, sigma, lambda, workspace, values);
  }
  std::string name() const override { return problem_.name(); }
  std::string variable_name(int i) const override { return problem_.variable_name(i); }
  std::string constraint_name(int j) const override { return problem_.constraint_name(j); }

 protected:
  const Nlp& problem_;
};

}  // namespace tenon
