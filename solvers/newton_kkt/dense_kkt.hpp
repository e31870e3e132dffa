// The KKT system of a small problem, dense:
//
//     K = [ H + diag(sigma)    J'      ]  n        S K S = P' L D L' P
//         [ J                 -diag(D) ]  m
//
// S is diagonal, powers of two: it equilibrates K without a rounding. Solves are refined against K. Equations: linear_algebra.md.
#pragma once

#include <cassert>

#include "tenon/solvers/newton_kkt/dense_ldlt.hpp"
#include "tenon/solvers/newton_kkt/equilibration.hpp"
#include "tenon/solvers/newton_kkt/refinement.hpp"

namespace tenon {

/// N variables, M rows: constants, or both Dynamic. Nothing allocates after construction.
template <class Scalar, int N, int M>
class DenseKkt {
 public:
  static constexpr int kSize = N == Dynamic || M == Dynamic ? Dynamic : N + M;

  explicit DenseKkt(int n = N, int m = M) : n_(n), m_(m), ldlt_(n + m) {
    const int rows = lanes::padded<Scalar>(n + m);
    k_.setZero(rows, n + m);
    scale_.setZero(rows);
    row_max_.setZero(rows);
    rhs_.setZero(rows);
    solution_.setZero(rows);
    previous_.setZero(rows);
    residual_.setZero(rows);
    weight_.setZero(rows);
  }

  /// hessian: n x n, its lower triangle is read; jacobian: m x n; sigma: n, >= 0, up to 1e30; d: m, >= 0.
  template <class HessianType, class JacobianType, class SigmaType, class DType>
  Inertia factor(const Eigen::MatrixBase<HessianType>& hessian, const Eigen::MatrixBase<JacobianType>& jacobian,
                 const Eigen::MatrixBase<SigmaType>& sigma, const Eigen::MatrixBase<DType>& d) {
    assemble(hessian, jacobian, sigma, d);
    if (!std::isfinite(k_.sum())) return refuse();
    equilibrate();
    return ldlt_.factor(k_);
  }

  /// K [dx; dlambda] = [r_x; r_c]. Returns the residual relative to the right-hand side, both equilibrated, (1.5): rounding times condition
  /// number. Towards 1 it says that K is singular although no pivot showed it. After zero > 0 the answer is finite but means little.
  template <class XType, class CType, class DxType, class DlambdaType>
  Scalar solve(const Eigen::MatrixBase<XType>& r_x, const Eigen::MatrixBase<CType>& r_c, DxType&& dx, DlambdaType&& dlambda);

 private:
  using Ldlt = DenseLdlt<Scalar, kSize>;
  using Storage = typename Ldlt::Storage;
  using PaddedVector = typename Ldlt::PaddedVector;
  static constexpr int kSweeps = 2;       // of the equilibration
  static constexpr int kRefinements = 5;  // at most

  int size() const { return ldlt_.size(); }

  template <class HessianType, class JacobianType, class SigmaType, class DType>
  void assemble(const HessianType& hessian, const JacobianType& jacobian, const SigmaType& sigma, const DType& d);
  void equilibrate();
  Inertia refuse();
  BackwardError<Scalar> backward_error();

  int n_, m_;
  Ldlt ldlt_;
  Storage k_;  // S K S, both triangles
  PaddedVector scale_, row_max_;
  PaddedVector rhs_, solution_, previous_, residual_, weight_;
};

template <class Scalar, int N, int M>
template <class HessianType, class JacobianType, class SigmaType, class DType>
void DenseKkt<Scalar, N, M>::assemble(const HessianType& hessian, const JacobianType& jacobian, const SigmaType& sigma, const DType& d) {
  assert(hessian.rows() == n_ && jacobian.rows() == m_ && jacobian.cols() == n_ && sigma.size() == n_ && d.size() == m_);
  for (int j = 0; j < n_; ++j) {
    k_(j, j) = hessian.coeff(j, j) + sigma.coeff(j);
    for (int i = j + 1; i < n_; ++i) k_(i, j) = k_(j, i) = hessian.coeff(i, j);
    for (int i = 0; i < m_; ++i) k_(n_ + i, j) = k_(j, n_ + i) = jacobian.coeff(i, j);
  }
  for (int j = 0; j < m_; ++j) {
    for (int i = 0; i < m_; ++i) k_(n_ + i, n_ + j) = 0;
    k_(n_ + j, n_ + j) = -d.coeff(j);
  }
}

// (1.2)
template <class Scalar, int N, int M>
void DenseKkt<Scalar, N, M>::equilibrate() {
  scale_.setOnes();
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (int j = 0; j < size(); ++j) row_max_[j] = lanes::max_abs(k_.col(j).data(), 0, size());
    for (int j = 0; j < size(); ++j) row_max_[j] = inverse_root_scale(row_max_[j]);
    for (int j = 0; j < size(); ++j) k_.col(j).array() *= row_max_.array() * row_max_[j];
    scale_.array() *= row_max_.array();
  }
}

// A matrix that is not finite is all zero eigenvalues, and solves to zero.
template <class Scalar, int N, int M>
Inertia DenseKkt<Scalar, N, M>::refuse() {
  k_.setZero();
  scale_.setOnes();
  return ldlt_.factor(k_);
}

// residual = r - K x, and its size (1.4)
template <class Scalar, int N, int M>
BackwardError<Scalar> DenseKkt<Scalar, N, M>::backward_error() {
  residual_ = rhs_;
  weight_ = rhs_.cwiseAbs();
  for (int j = 0; j < size(); ++j) {
    residual_.noalias() -= k_.col(j) * solution_[j];
    weight_.noalias() += k_.col(j).cwiseAbs() * std::abs(solution_[j]);
  }
  constexpr Scalar floor = std::numeric_limits<Scalar>::min();  // 0 / 0 is 0
  return {(residual_.array().abs() / (weight_.array() + floor)).maxCoeff(), residual_.template lpNorm<Eigen::Infinity>()};
}

template <class Scalar, int N, int M>
template <class XType, class CType, class DxType, class DlambdaType>
Scalar DenseKkt<Scalar, N, M>::solve(const Eigen::MatrixBase<XType>& r_x, const Eigen::MatrixBase<CType>& r_c, DxType&& dx,
                                   DlambdaType&& dlambda) {
  assert(r_x.size() == n_ && r_c.size() == m_ && dx.size() == n_ && dlambda.size() == m_);
  for (int i = 0; i < n_; ++i) rhs_[i] = scale_[i] * r_x.coeff(i);
  for (int i = 0; i < m_; ++i) rhs_[n_ + i] = scale_[n_ + i] * r_c.coeff(i);
  solution_ = rhs_;
  ldlt_.solve_in_place(solution_);

  const BackwardError<Scalar> error = refine(solution_, residual_, previous_, kRefinements,
                              [this](PaddedVector& x) { ldlt_.solve_in_place(x); }, [this] { return backward_error(); });
  for (int i = 0; i < n_; ++i) dx.coeffRef(i) = scale_[i] * solution_[i];
  for (int i = 0; i < m_; ++i) dlambda.coeffRef(i) = scale_[n_ + i] * solution_[n_ + i];
  return error.largest / std::max(rhs_.template lpNorm<Eigen::Infinity>(), std::numeric_limits<Scalar>::min());  // (1.5)
}

}  // namespace tenon
