// KKT system whose Hessian is N blocks of 2 x 2 (u_i, a_i), condensed to M x M.
//
//     [ H_1            A_1' ] [ d_1     ]   [ r_1 ]        S = sum_i A_i H_i^-1 A_i' + D,      A_i = [ j_ui  j_ai ]  (M x 2)
//     [      ...       ...  ] [ ...     ] = [ ... ]        S dlambda = sum_i A_i H_i^-1 r_i - r_c
//     [ A_1  ...       -D   ] [ dlambda ]   [ r_c ]        d_i = H_i^-1 (r_i - A_i' dlambda)
//
// Inertia by Sylvester and Haynsworth: In(K) = sum In(H_i) + In(-S). The blocks' 2 x 2 inverses need H_i to be regular, not positive.
#pragma once

#include "tenon/core/pair_block_diagonal.hpp"
#include "tenon/solvers/newton_kkt/small_ldlt.hpp"

namespace tenon {

template <class Scalar, int N, int M>
class ArmBlockKkt {
 public:
  using VectorN = Eigen::Matrix<Scalar, 2 * N, 1>;
  using VectorM = Eigen::Matrix<Scalar, M, 1>;
  using Jacobian = Eigen::Matrix<Scalar, M, 2 * N>;

  ArmBlockKkt(int /*n*/, int /*m*/) {}

  Inertia factor(const PairBlockDiagonal<Scalar, N>& h, const Jacobian& jacobian, const VectorN& sigma, const VectorM& d) {
    jacobian_ = jacobian;
    const Array uu = h.uu + sigma.array().template head<N>(), aa = h.aa + sigma.array().template tail<N>();
    const Array determinant = uu * aa - h.au.square();
    const Array inverse = determinant.inverse();
    inverse_uu_ = aa * inverse, inverse_au_ = -h.au * inverse, inverse_aa_ = uu * inverse;

    // B_i = A_i H_i^-1
    for (int i = 0; i < N; ++i) {
      b_.col(i) = jacobian_.col(i) * inverse_uu_[i] + jacobian_.col(N + i) * inverse_au_[i];
      b_.col(N + i) = jacobian_.col(i) * inverse_au_[i] + jacobian_.col(N + i) * inverse_aa_[i];
    }
    schur_.noalias() = b_ * jacobian_.transpose();
    schur_.diagonal() += d;

    // a block is singular to working precision where its determinant is mere rounding
    const Scalar epsilon = 4 * std::numeric_limits<Scalar>::epsilon();
    Inertia inertia;
    for (int i = 0; i < N; ++i) {
      if (std::abs(determinant[i]) <= epsilon * std::abs(uu[i] * aa[i])) ++inertia.zero;
      if (determinant[i] < 0) ++inertia.positive, ++inertia.negative;
      else inertia.positive += 2 * (uu[i] > 0), inertia.negative += 2 * (uu[i] <= 0);
    }
    const Inertia schur = ldlt_.factor(schur_);
    inertia.positive += schur.negative;
    inertia.negative += schur.positive;
    inertia.zero += schur.zero;
    return inertia;
  }

  void solve(const VectorN& r_x, const VectorM& r_c, VectorN& dx, VectorM& dlambda) const {
    dlambda.noalias() = b_ * r_x;
    dlambda -= r_c;
    ldlt_.solve_in_place(dlambda);
    VectorN right = r_x;
    right.noalias() -= jacobian_.transpose() * dlambda;
    const auto ru = right.array().template head<N>(), ra = right.array().template tail<N>();
    dx.template head<N>() = (inverse_uu_ * ru + inverse_au_ * ra).matrix();
    dx.template tail<N>() = (inverse_au_ * ru + inverse_aa_ * ra).matrix();
  }

 private:
  using Array = Eigen::Array<Scalar, N, 1>;

  Array inverse_uu_, inverse_au_, inverse_aa_;
  Jacobian jacobian_, b_;  // b_ = J H^-1
  Eigen::Matrix<Scalar, M, M> schur_;
  SmallLdlt<Scalar, M> ldlt_;
};

}  // namespace tenon
