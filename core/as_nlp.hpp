// AsNlp<P>: any fixed-size problem as an `Nlp`, so that every back end can take it.
//
// A full compressed-column pattern is exactly column-major storage, so a dense fixed-size matrix is copied by one Map; a structured
// Hessian says its own pattern and order through `lower_pattern()` and `write_lower(values)`.
#pragma once

#include <utility>

#include "tenon/core/nlp.hpp"

namespace tenon {

template <NonlinearProgram P>
  requires kFixedSize<P>
class AsNlp final : public Nlp {
 public:
  /// Refers to the problem, which must outlive this: its setters stay in the owner's hands.
  explicit AsNlp(const P& problem) : problem_(problem) {}

  int num_variables() const override { return kN; }
  int num_constraints() const override { return kM; }

  SparsePattern jacobian_pattern() const override { return SparsePattern::full(kM, kN); }
  SparsePattern hessian_pattern() const override {
    if constexpr (kDenseHessian) return SparsePattern::full_lower(kN);
    else return HessianOf<P>::lower_pattern();
  }

  void bounds(Bounds& bounds) const override {
    BoundsOf<P> fixed;
    problem_.bounds(fixed);
    bounds.x_lower = fixed.x_lower.template cast<double>();
    bounds.x_upper = fixed.x_upper.template cast<double>();
    bounds.c_lower = fixed.c_lower.template cast<double>();
    bounds.c_upper = fixed.c_upper.template cast<double>();
    bounds.compliance = fixed.compliance.template cast<double>();
    bounds.preload = fixed.preload.template cast<double>();
  }

  void initial_point(VectorRef x) const override {
    if constexpr (requires(VectorNOf<P>& start) { problem_.initial_point(start); }) {
      VectorNOf<P> start;
      problem_.initial_point(start);
      FixedN(x.data()) = start.template cast<double>();
    } else {
      x.setZero();
    }
  }

  std::vector<SoftRow> soft_rows() const override {
    if constexpr (requires { problem_.soft_rows(); }) return problem_.soft_rows();
    else return Nlp::soft_rows();
  }
  void nominal_values(VectorRef variables, VectorRef rows) const override {
    if constexpr (requires { problem_.nominal_values(variables, rows); }) problem_.nominal_values(variables, rows);
  }
  HessianKind hessian_kind() const override {
    if constexpr (requires { problem_.hessian_kind(); }) return problem_.hessian_kind();
    else return Nlp::hessian_kind();
  }

  Workspace make_workspace() const override { return std::make_unique<FixedScratch>(problem_.make_workspace()); }

  void prepare(ConstVectorRef x, Workspace& workspace) const override {
    FixedScratch& scratch = fixed(workspace);
    scratch.x = x.cast<typename P::Scalar>();
    problem_.prepare(scratch.x, scratch.workspace);
  }

  double objective(ConstVectorRef, Workspace& workspace) const override {
    return double(problem_.objective(fixed(workspace).x, fixed(workspace).workspace));
  }

  void gradient(ConstVectorRef, Workspace& workspace, VectorRef gradient) const override {
    VectorNOf<P> out;
    problem_.gradient(fixed(workspace).x, fixed(workspace).workspace, out);
    FixedN(gradient.data()) = out.template cast<double>();
  }

  void constraints(ConstVectorRef, Workspace& workspace, VectorRef values) const override {
    VectorMOf<P> out;
    problem_.constraints(fixed(workspace).x, fixed(workspace).workspace, out);
    FixedM(values.data()) = out.template cast<double>();
  }

  void jacobian(ConstVectorRef, Workspace& workspace, std::span<double> values) const override {
    JacobianOf<P> out;
    problem_.jacobian(fixed(workspace).x, fixed(workspace).workspace, out);
    Eigen::Map<Eigen::Matrix<double, kM, kN>>(values.data()) = out.template cast<double>();
  }

  void hessian(ConstVectorRef, double sigma, ConstVectorRef lambda, Workspace& workspace, std::span<double> values) const override {
    HessianOf<P> out;
    const VectorMOf<P> multipliers = lambda.cast<typename P::Scalar>();
    problem_.hessian(fixed(workspace).x, typename P::Scalar(sigma), multipliers, fixed(workspace).workspace, out);
    if constexpr (kDenseHessian) {
      std::size_t k = 0;
      for (int j = 0; j < kN; ++j) {
        for (int i = j; i < kN; ++i) values[k++] = double(out(i, j));
      }
    } else {
      out.write_lower(values);
    }
  }

  std::string name() const override {
    if constexpr (requires { problem_.name(); }) return problem_.name();
    else return Nlp::name();
  }
  std::string variable_name(int i) const override {
    if constexpr (requires { problem_.variable_name(i); }) return problem_.variable_name(i);
    else return Nlp::variable_name(i);
  }
  std::string constraint_name(int j) const override {
    if constexpr (requires { problem_.constraint_name(j); }) return problem_.constraint_name(j);
    else return Nlp::constraint_name(j);
  }

 private:
  static constexpr int kN = P::kVariables;
  static constexpr int kM = P::kConstraints;
  static constexpr bool kDenseHessian = std::is_base_of_v<Eigen::MatrixBase<HessianOf<P>>, HessianOf<P>>;

  // Written at their fixed size: Eigen's loop over a length known only at run time would be longer, and GCC takes it for an overrun.
  using FixedN = Eigen::Map<Eigen::Matrix<double, kN, 1>>;
  using FixedM = Eigen::Map<Eigen::Matrix<double, kM, 1>>;

  struct FixedScratch final : Scratch {
    explicit FixedScratch(WorkspaceOf<P>&& made) : workspace(std::move(made)) {}
    VectorNOf<P> x;
    WorkspaceOf<P> workspace;
  };
  static FixedScratch& fixed(Workspace& workspace) { return static_cast<FixedScratch&>(*workspace); }

  const P& problem_;
};

}  // namespace tenon
