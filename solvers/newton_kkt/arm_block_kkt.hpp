// KKT system of wrench allocation: N blocks of 2 x 2 (u_i, a_i) meet in the 6 rows of a wrench, and condense to 6 x 6.
//
//     [ H_1            A_1' ] [ d_1     ]   [ r_1 ]        S = sum_i A_i H_i^-1 A_i' + D,      A_i = [ j_ui  j_ai ]  (6 x 2)
//     [      ...       ...  ] [ ...     ] = [ ... ]        S dlambda = sum_i A_i H_i^-1 r_i - r_c
//     [ A_1  ...       -D   ] [ dlambda ]   [ r_c ]        d_i = H_i^-1 (r_i - A_i' dlambda)
//
// Inertia by Sylvester and Haynsworth: In(K) = sum In(H_i) + In(-S). The 2 x 2 inverses need the blocks to be regular, not positive.
#pragma once

#include "tenon/core/pair_block_diagonal.hpp"
#include "tenon/solvers/newton_kkt/small_ldlt.hpp"

namespace tenon {

template <class Scalar, int N>
class ArmBlockKkt {
 public:
  static constexpr int kRows = 6;
  using VectorN = Eigen::Matrix<Scalar, 2 * N, 1>;
  using VectorM = Eigen::Matrix<Scalar, kRows, 1>;
  using Jacobian = Eigen::Matrix<Scalar, kRows, 2 * N>;

  ArmBlockKkt(int /*n*/, int /*m*/) {}

  /// `jacobian` must stay as it is until the last solve().
  Inertia factor(const PairBlockDiagonal<Scalar, N>& h, const Jacobian& jacobian, const VectorN& sigma, const VectorM& d) {
    jacobian_ = &jacobian;
    const Lanes uu = h.uu + sigma.array().template head<N>(), aa = h.aa + sigma.array().template tail<N>();
    const Lanes determinant = uu * aa - h.au.square();
    const Lanes inverse = determinant.inverse();
    inverse_uu_ = aa * inverse, inverse_au_ = -h.au * inverse, inverse_aa_ = uu * inverse;
    condense(jacobian, d);

    Inertia inertia = inertia_of_blocks(uu, aa, determinant);
    const Inertia schur = ldlt_.factor(schur_);
    inertia.positive += schur.negative;
    inertia.negative += schur.positive;
    inertia.zero += schur.zero;
    return inertia;
  }

  void solve(const VectorN& r_x, const VectorM& r_c, VectorN& dx, VectorM& dlambda) const {
    VectorM even = -r_c, odd = VectorM::Zero();
    for (int i = 0; i < N; ++i) {
      even += b_.col(i) * r_x[i];
      odd += b_.col(N + i) * r_x[N + i];
    }
    dlambda = even + odd;
    ldlt_.solve_in_place(dlambda);

    VectorN right = r_x;
    right.noalias() -= jacobian_->transpose() * dlambda;
    const auto ru = right.array().template head<N>(), ra = right.array().template tail<N>();
    dx.template head<N>() = (inverse_uu_ * ru + inverse_au_ * ra).matrix();
    dx.template tail<N>() = (inverse_au_ * ru + inverse_aa_ * ra).matrix();
  }

 private:
  using Lanes = Eigen::Array<Scalar, N, 1>;
  using Four = Eigen::Array<Scalar, 4, 1>;
  using Two = Eigen::Array<Scalar, 2, 1>;

  /// B = J H^-1 and the lower triangle of S = B J' + D, in pieces that are whole registers: of columns 0 and 1 rows 0-3 and 4-5, of columns
  /// 2 and 3 rows 2-5, of columns 4 and 5 rows 4-5.
  void condense(const Jacobian& jacobian, const VectorM& d) {
    Four top[2], middle[2];
    Two bottom[4];
    for (Four& v : top) v.setZero();
    for (Four& v : middle) v.setZero();
    for (Two& v : bottom) v.setZero();
    for (int i = 0; i < N; ++i) {
      const Scalar* u = &jacobian(0, i);
      const Scalar* a = &jacobian(0, N + i);
      const Scalar iuu = inverse_uu_[i], iau = inverse_au_[i], iaa = inverse_aa_[i];
      const Four u_top = rows<Four>(u), a_top = rows<Four>(a), u_middle = rows<Four>(u + 2), a_middle = rows<Four>(a + 2);
      const Two u_bottom = rows<Two>(u + 4), a_bottom = rows<Two>(a + 4);
      const Four bu_top = u_top * iuu + a_top * iau, ba_top = u_top * iau + a_top * iaa;
      const Four bu_middle = u_middle * iuu + a_middle * iau, ba_middle = u_middle * iau + a_middle * iaa;
      const Two bu_bottom = u_bottom * iuu + a_bottom * iau, ba_bottom = u_bottom * iau + a_bottom * iaa;
      b_.col(i).template head<4>() = bu_top.matrix(), b_.col(i).template tail<2>() = bu_bottom.matrix();
      b_.col(N + i).template head<4>() = ba_top.matrix(), b_.col(N + i).template tail<2>() = ba_bottom.matrix();
      for (int k = 0; k < 2; ++k) {
        top[k] += bu_top * u[k] + ba_top * a[k];
        bottom[k] += bu_bottom * u[k] + ba_bottom * a[k];
        middle[k] += bu_middle * u[2 + k] + ba_middle * a[2 + k];
        bottom[2 + k] += bu_bottom * u[4 + k] + ba_bottom * a[4 + k];
      }
    }
    for (int k = 0; k < 2; ++k) {
      schur_.col(k).template head<4>() = top[k].matrix(), schur_.col(k).template tail<2>() = bottom[k].matrix();
      schur_.col(2 + k).template tail<4>() = middle[k].matrix();
      schur_.col(4 + k).template tail<2>() = bottom[2 + k].matrix();
    }
    schur_.diagonal() += d;
  }

  template <class Rows>
  static Rows rows(const Scalar* column) {
    return Eigen::Map<const Rows>(column);
  }

  static Inertia inertia_of_blocks(const Lanes& uu, const Lanes& aa, const Lanes& determinant) {
    Inertia inertia;
    const Lanes rounding = 4 * std::numeric_limits<Scalar>::epsilon() * (uu * aa).abs();
    if (uu.minCoeff() > 0 && (determinant - rounding).minCoeff() > 0) {
      inertia.positive = 2 * N;
      return inertia;
    }
    for (int i = 0; i < N; ++i) {
      inertia.zero += std::abs(determinant[i]) <= rounding[i];  // singular to working precision
      const int negative = determinant[i] < 0 ? 1 : uu[i] > 0 ? 0 : 2;
      inertia.negative += negative;
      inertia.positive += 2 - negative;
    }
    return inertia;
  }

  Lanes inverse_uu_, inverse_au_, inverse_aa_;
  const Jacobian* jacobian_ = nullptr;
  Jacobian b_;  // J H^-1
  Eigen::Matrix<Scalar, kRows, kRows> schur_ = Eigen::Matrix<Scalar, kRows, kRows>::Zero();
  SmallLdlt<Scalar, kRows> ldlt_;
};

}  // namespace tenon
