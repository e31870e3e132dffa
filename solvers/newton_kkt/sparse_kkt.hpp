// The KKT system of a sparse problem:
//
//     K = [ H + diag(sigma)    J'      ]  n        S K S = P' L D L' P
//         [ J                 -diag(D) ]  m
//
// The patterns of H and J are fixed: order of elimination and memory are settled at construction. S equilibrates K, by powers of two.
// Small systems need no path of their own: fronts beat dense_ldlt.hpp from some 40 sparse unknowns on. Equations: linear_algebra.md.
#pragma once

#include <optional>
#include <vector>

#include "tenon/core/sparse_pattern.hpp"
#include "tenon/solvers/newton_kkt/multifrontal_ldlt.hpp"
#include "tenon/solvers/newton_kkt/refinement.hpp"

namespace tenon {

class SparseKkt {
 public:
  /// hessian: lower triangle, n x n; jacobian: m x n. Nothing allocates after construction.
  SparseKkt(const SparsePattern& hessian, const SparsePattern& jacobian);

  /// hessian, jacobian: with these patterns; sigma: n, >= 0, up to 1e30; d: m, >= 0.
  Inertia factor(const SparseMatrix& hessian, const SparseMatrix& jacobian, ConstVectorRef sigma, ConstVectorRef d);

  /// K [dx; dlambda] = [r_x; r_c]. Returns the residual relative to the right-hand side, both equilibrated, (1.5): rounding times condition
  /// number. Towards 1 it says that K is singular although no pivot showed it. After zero > 0 the answer is finite but means little.
  double solve(ConstVectorRef r_x, ConstVectorRef r_c, VectorRef dx, VectorRef dlambda);

 private:
  int size() const { return n_ + m_; }
  void assemble(const SparseMatrix& hessian, const SparseMatrix& jacobian, ConstVectorRef sigma, ConstVectorRef d);
  void equilibrate();
  BackwardError<double> backward_error();

  int n_, m_;
  SparsePattern lower_;                              // of K, with its whole diagonal first in each column
  std::vector<int> hessian_places_, jacobian_places_;  // where their entries are in lower_
  Vector values_;                                    // of S K S
  Vector scale_, row_max_;
  std::optional<MultifrontalLdlt> ldlt_;
  Vector rhs_, solution_, previous_, residual_, weight_;
};

}  // namespace tenon
