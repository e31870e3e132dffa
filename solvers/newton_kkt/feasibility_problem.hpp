// The problem that restoration solves: as little violation as can be had, near a point x_R, within the same bounds.
//
//     min  zeta/2 |W (x - x_R)|^2 + 1/2 |e|^2     s.t.  c_lower <= c(x) - e <= c_upper,   x_lower <= x <= x_upper,     W = diag(1/max(1, |x_R|))
//
// Every hard row becomes compliant with D = 1, so that the same loop and the same linear algebra solve it: lambda is then the violation itself.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "tenon/core/nlp.hpp"
#include "tenon/core/pair_block_diagonal.hpp"

namespace tenon {

template <NonlinearProgram P>
class FeasibilityProblem {
 public:
  using Scalar = typename P::Scalar;
  struct Workspace {
    WorkspaceOf<P> problem;
    std::vector<double> hessian;  // sparse problems: the entries in the problem's own pattern
  };
  using Hessian = HessianOf<P>;
  static constexpr int kVariables = P::kVariables;
  static constexpr int kConstraints = P::kConstraints;
  using VectorN = VectorNOf<P>;
  using VectorM = VectorMOf<P>;

  explicit FeasibilityProblem(const P& problem) : problem_(problem), reference_(problem.num_variables()), weight_(problem.num_variables()) {
    if constexpr (!kFixedSize<P>) place_diagonal();
  }

  /// Stay near x, with this weight.
  void set_reference(const VectorN& x, Scalar zeta) {
    reference_ = x;
    weight_ = zeta / x.array().abs().max(Scalar(1)).square();
  }
  /// Largest component of the force with which the proximal term holds x back.
  Scalar pull(const VectorN& x) const { return weight_.cwiseProduct(x - reference_).template lpNorm<Eigen::Infinity>(); }

  int num_variables() const { return problem_.num_variables(); }
  int num_constraints() const { return problem_.num_constraints(); }
  Stages stages() const { return problem_.stages(); }
  SparsePattern jacobian_pattern() const { return problem_.jacobian_pattern(); }
  SparsePattern hessian_pattern() const { return pattern_; }
  Workspace make_workspace() const { return {problem_.make_workspace(), std::vector<double>(places_.size())}; }

  void bounds(BoundsOf<P>& bounds) const {
    problem_.bounds(bounds);
    for (Eigen::Index i = 0; i < bounds.compliance.size(); ++i) {
      if (bounds.compliance[i] == 0) bounds.compliance[i] = 1, bounds.preload[i] = 0;
    }
  }

  void prepare(const VectorN& x, Workspace& workspace) const { problem_.prepare(x, workspace.problem); }
  Scalar objective(const VectorN& x, Workspace&) const { return (weight_.array() * (x - reference_).array().square()).sum() / 2; }
  void gradient(const VectorN& x, Workspace&, VectorN& gradient) const { gradient = weight_.cwiseProduct(x - reference_); }
  void constraints(const VectorN& x, Workspace& workspace, VectorM& values) const { problem_.constraints(x, workspace.problem, values); }
  void jacobian(const VectorN& x, Workspace& workspace, auto&& values) const { problem_.jacobian(x, workspace.problem, values); }

  void hessian(const VectorN& x, Scalar sigma, const VectorM& lambda, Workspace& workspace, auto&& values) const {
    if constexpr (kFixedSize<P>) {
      problem_.hessian(x, Scalar(0), lambda, workspace.problem, values);
      add_diagonal(values, sigma);
    } else {
      // the problem's entries first, in their own order; then each goes to its place in the pattern with a whole diagonal
      const std::span<double> own(workspace.hessian);
      problem_.hessian(x, Scalar(0), lambda, workspace.problem, own);
      std::fill(values.begin(), values.end(), 0.0);
      for (std::size_t k = 0; k < own.size(); ++k) values[static_cast<std::size_t>(places_[k])] = own[k];
      for (std::size_t j = 0; j < diagonal_.size(); ++j) values[static_cast<std::size_t>(diagonal_[j])] += sigma * weight_[Eigen::Index(j)];
    }
  }

 private:
  void place_diagonal() {
    const SparsePattern own = problem_.hessian_pattern();
    std::vector<std::pair<int, int>> entries;
    for (int j = 0; j < own.cols; ++j) {
      entries.emplace_back(j, j);
      for (int k = own.outer[std::size_t(j)]; k < own.outer[std::size_t(j) + 1]; ++k) entries.emplace_back(own.inner[std::size_t(k)], j);
    }
    pattern_ = SparsePattern::from_entries(own.rows, own.cols, std::move(entries));
    for (int j = 0; j < own.cols; ++j) {
      diagonal_.push_back(pattern_.find(j, j));
      for (int k = own.outer[std::size_t(j)]; k < own.outer[std::size_t(j) + 1]; ++k) {
        places_.push_back(pattern_.find(own.inner[std::size_t(k)], j));
      }
    }
  }

  template <class Matrix>
  void add_diagonal(Eigen::MatrixBase<Matrix>& hessian, Scalar sigma) const {
    hessian.diagonal() += sigma * weight_;
  }
  template <int N>
  void add_diagonal(PairBlockDiagonal<Scalar, N>& hessian, Scalar sigma) const {
    hessian.uu += sigma * weight_.array().template head<N>();
    hessian.aa += sigma * weight_.array().template tail<N>();
  }

  const P& problem_;
  VectorN reference_, weight_;
  SparsePattern pattern_;               // sparse problems: the Hessian's, with a whole diagonal
  std::vector<int> places_, diagonal_;  // in pattern_
};

}  // namespace tenon
