// Which linear algebra a problem gets: by the sizes of its stages where it knows them when compiled, else by the type of its Hessian.
//
// Every kind has the same verbs:  factor(H, J, sigma, d) -> Inertia  and  solve(r_x, r_c, dx, dlambda)  for
//
//     [ H + diag(sigma)   J'       ] [ dx      ]     [ r_x ]
//     [ J                -diag(d)  ] [ dlambda ]  =  [ r_c ]
#pragma once

#include <type_traits>

#include "tenon/core/nlp.hpp"
#include "tenon/core/pair_block_diagonal.hpp"
#include "tenon/solvers/newton_kkt/arm_block_kkt.hpp"
#include "tenon/solvers/newton_kkt/dense_kkt.hpp"
#include "tenon/solvers/newton_kkt/sparse_kkt.hpp"
#include "tenon/solvers/newton_kkt/stage_kkt.hpp"

namespace tenon {

namespace detail {
template <class Hessian, int M>
struct KktFor;
template <class Scalar, int N, int M>
struct KktFor<Eigen::Matrix<Scalar, N, N>, M> {
  using type = DenseKkt<Scalar, N, M>;
};
template <class Scalar, int N>
struct KktFor<PairBlockDiagonal<Scalar, N>, ArmBlockKkt<Scalar, N>::kRows> {
  using type = ArmBlockKkt<Scalar, N>;
};
template <int M>
struct KktFor<SparseMatrix, M> {
  using type = SparseKkt;
};
template <class P>
struct KktOfProblem : KktFor<HessianOf<P>, P::kConstraints> {};
template <class P>
  requires requires { typename P::StageSizes; }
struct KktOfProblem<P> {
  using type = StageKkt<typename P::StageSizes>;
};
}  // namespace detail

template <class P>
using KktOf = typename detail::KktOfProblem<P>::type;

/// Analyses the patterns, and the stages where the kind takes them; a fixed-size kind needs none.
template <class Kkt, class P>
Kkt make_kkt(const P& problem) {
  if constexpr (kFixedSize<P>) return Kkt(problem.num_variables(), problem.num_constraints());
  else if constexpr (std::is_constructible_v<Kkt, Stages, SparsePattern, SparsePattern>)
    return Kkt(problem.stages(), problem.hessian_pattern(), problem.jacobian_pattern());
  else return Kkt(problem.hessian_pattern(), problem.jacobian_pattern());
}

template <class Matrix>
void set_zero(Eigen::MatrixBase<Matrix>& hessian) {
  hessian.setZero();
}
inline void set_zero(SparseMatrix& hessian) { std::fill_n(hessian.valuePtr(), hessian.nonZeros(), 0.0); }
template <class Scalar, int N>
void set_zero(PairBlockDiagonal<Scalar, N>& hessian) {
  hessian.uu.setZero(), hessian.au.setZero(), hessian.aa.setZero();
}

}  // namespace tenon
