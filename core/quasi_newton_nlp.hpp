// QuasiNewtonNlp: a problem without a Hessian as one with an approximation of it. A decorator.
//
// Damped BFGS, dense: from one iterate to the next, with the multipliers lambda of the second,
//
//     s = x - x_last,   y = grad_x L(x, lambda) - grad_x L(x_last, lambda)
//     r = theta y + (1 - theta) B s,   theta = 1 where s'y >= 0.2 s'B s, else 0.8 s'B s / (s'B s - s'y)
//     B <- B - (B s)(B s)' / s'B s + r r' / s'r                                       [Nocedal & Wright 2006, procedure 18.2]       (1)
//
// B stays positive definite, whatever the curvature: steps need no inertia correction. It starts as y'y/s'y I [NW06, eq. 6.20].
//
// B is a memory of the iterates, the one exception to the rule that evaluations depend on x alone. It lives in the workspace: whoever owns
// that owns the memory. hessian() is to be called once for each accepted iterate, as Newton-KKT does.
#pragma once

#include "tenon/core/nlp_decorator.hpp"

namespace tenon {

class QuasiNewtonNlp final : public NlpDecorator {
 public:
  /// A dense B beyond this would be the wrong means.
  static constexpr int kMostVariables = 500;

  /// Refers to the problem, which must outlive this. Throws std::invalid_argument where it has more variables than that.
  explicit QuasiNewtonNlp(const Nlp& problem);

  /// Every workspace forgets what it learnt: between two solves that have nothing to do with one another.
  void forget() { ++epoch_; }

  Stages stages() const override { return {}; }  // its patterns are not those of stages
  SparsePattern hessian_pattern() const override { return SparsePattern::full_lower(num_variables()); }
  HessianKind hessian_kind() const override { return HessianKind::exact; }  // as far as a solver is concerned
  Workspace make_workspace() const override;
  void prepare(ConstVectorRef x, Workspace& workspace) const override { problem_.prepare(x, memory(workspace).problem); }
  double objective(ConstVectorRef x, Workspace& workspace) const override { return problem_.objective(x, memory(workspace).problem); }
  void gradient(ConstVectorRef x, Workspace& workspace, VectorRef gradient) const override;
  void constraints(ConstVectorRef x, Workspace& workspace, VectorRef values) const override {
    problem_.constraints(x, memory(workspace).problem, values);
  }
  void jacobian(ConstVectorRef x, Workspace& workspace, std::span<double> values) const override;
  void hessian(ConstVectorRef x, double sigma, ConstVectorRef lambda, Workspace& workspace, std::span<double> values) const override;

 private:
  /// First derivatives at one x; NaN for the x of what was never evaluated.
  struct Linearisation {
    Vector x_of_gradient, gradient;
    Vector x_of_jacobian;
    SparseMatrix jacobian;
  };
  struct Memory final : Scratch {
    Workspace problem;
    Linearisation here, last;
    bool has_last = false, has_curvature = false;
    int epoch = 0;
    Eigen::MatrixXd B;  // the lower triangle
    Vector s, y, Bs;    // room for (1)
  };
  static Memory& memory(Workspace& workspace) { return static_cast<Memory&>(*workspace); }
  static void update(Memory& at);

  int epoch_ = 0;
};

}  // namespace tenon
