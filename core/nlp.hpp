// The problem contract.
//
//     minimise  f(x)    subject to    c_lower <= c(x) <= c_upper,    x_lower <= x <= x_upper
//
//     L(x; sigma, lambda) = sigma f(x) + lambda' c(x) + z' x
//
// One sign convention everywhere:  grad f + J' lambda + z = 0  at a solution; a multiplier is positive at its upper bound and negative
// at its lower one. Equality is lower == upper, an absent bound is +-infinity. There are no slacks and no two kinds of constraint.
//
// A row may be compliant: with compliance D > 0 it gives way by e at the price e^2/(2 D), like a spring that carries lambda = e/D. The row
// then reads c_lower <= c(x) - e <= c_upper with e = D (lambda - preload); D = 0, the default, is a hard row.
//
// Promises of a problem: outputs arrive unset and every stored entry is written; evaluations are const, deterministic and allocate nothing; a
// non-finite value IS the report "cannot evaluate here"; sizes and patterns never change, and what moves between solves (a target, a
// measured state, a bound) is a setter of the problem.
#pragma once

#include <concepts>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "tenon/core/eigen.hpp"
#include "tenon/core/sparse_pattern.hpp"
#include "tenon/core/stages.hpp"

namespace tenon {

template <class Scalar>
inline constexpr Scalar kInfinity = std::numeric_limits<Scalar>::infinity();

/// Bounds of the n variables and the m rows; an absent bound is +-infinity.
template <class Scalar, int N, int M>
struct BasicBounds {
  Eigen::Matrix<Scalar, N, 1> x_lower, x_upper;  // n
  Eigen::Matrix<Scalar, M, 1> c_lower, c_upper;  // m
  Eigen::Matrix<Scalar, M, 1> compliance;        // m, >= 0: D of each row, 0 for a hard one
  Eigen::Matrix<Scalar, M, 1> preload;           // m: the multiplier at which a compliant row does not give way

  BasicBounds() : BasicBounds(N == Dynamic ? 0 : N, M == Dynamic ? 0 : M) {}

  /// No bound at all, hard rows without limits.
  BasicBounds(int n, int m) : x_lower(n), x_upper(n), c_lower(m), c_upper(m), compliance(m), preload(m) { remove_limits(); }

  /// As a problem expects to be given them.
  void remove_limits() {
    x_lower.setConstant(-kInfinity<Scalar>);
    x_upper.setConstant(kInfinity<Scalar>);
    c_lower.setConstant(-kInfinity<Scalar>);
    c_upper.setConstant(kInfinity<Scalar>);
    compliance.setZero();
    preload.setZero();
  }
};

using Bounds = BasicBounds<double, Dynamic, Dynamic>;

/// A row that may be violated at a price: linear |v| + quadratic/2 v^2, v what it lies outside its bounds. An exact penalty: as long as the
/// hard problem's |lambda| is below `linear`, its solution is the soft one's too.
struct SoftRow {
  int row = 0;
  double linear = 0;     // > 0, per unit of the row
  double quadratic = 0;  // >= 0, per unit of the row squared
};

/// What `hessian` gives.
enum class HessianKind {
  exact,         // the Hessian of the Lagrangian
  gauss_newton,  // a positive semidefinite part of it, near the whole where residuals or curvatures are small
  none,          // nothing (its pattern is empty): a solver that needs one keeps an approximation of its own
};

/// The virtual face of the contract: sizes known at run time, sparse derivatives. Every back end takes it.
class Nlp {
 public:
  /// What the evaluations at one x share (a kinematics, an integration sweep). Null where a problem has nothing to share.
  class Scratch {
   public:
    virtual ~Scratch() = default;
  };

  using Scalar = double;
  using Workspace = std::unique_ptr<Scratch>;
  static constexpr int kVariables = Dynamic;
  static constexpr int kConstraints = Dynamic;

  virtual ~Nlp() = default;

  virtual int num_variables() const = 0;    // n
  virtual int num_constraints() const = 0;  // m

  /// Non-zeros of the Jacobian (m x n), and of the lower triangle of the Hessian of the Lagrangian (n x n). Asked for once.
  virtual SparsePattern jacobian_pattern() const = 0;
  virtual SparsePattern hessian_pattern() const = 0;

  /// The stages of an optimal control problem; none where the problem has no such structure. Asked for once.
  virtual Stages stages() const { return {}; }

  /// Fills bounds that arrive with the right sizes and without any limit. Asked for at the start of every solve.
  virtual void bounds(Bounds& bounds) const = 0;

  /// Rows that may be violated at a price; their compliance is 0. Asked for once.
  virtual std::vector<SoftRow> soft_rows() const { return {}; }

  /// The typical size of each variable (n) and of each row's values (m), > 0: 1e-6 for a gap in metres. They arrive as 0, not stated.
  virtual void nominal_values(VectorRef variables, VectorRef rows) const { static_cast<void>(variables), static_cast<void>(rows); }

  virtual HessianKind hessian_kind() const { return HessianKind::exact; }

  /// A point to start from (n). The default is 0.
  virtual void initial_point(VectorRef x) const { x.setZero(); }

  virtual Workspace make_workspace() const { return nullptr; }

  /// Called once for each new x, before any evaluation there.
  virtual void prepare(ConstVectorRef x, Workspace& workspace) const {
    static_cast<void>(x), static_cast<void>(workspace);
  }

  virtual double objective(ConstVectorRef x, Workspace& workspace) const = 0;
  virtual void gradient(ConstVectorRef x, Workspace& workspace, VectorRef gradient) const = 0;            // n
  virtual void constraints(ConstVectorRef x, Workspace& workspace, VectorRef values) const = 0;           // m
  virtual void jacobian(ConstVectorRef x, Workspace& workspace, std::span<double> values) const = 0;      // in the order of the pattern
  virtual void hessian(ConstVectorRef x, double sigma, ConstVectorRef lambda, Workspace& workspace,
                       std::span<double> values) const = 0;                                               // lower triangle of hess L

  virtual std::string name() const { return "problem"; }
  virtual std::string variable_name(int i) const { return "x[" + std::to_string(i) + "]"; }
  virtual std::string constraint_name(int j) const { return "c[" + std::to_string(j) + "]"; }
};

template <class P>
using VectorNOf = Eigen::Matrix<typename P::Scalar, P::kVariables, 1>;
template <class P>
using VectorMOf = Eigen::Matrix<typename P::Scalar, P::kConstraints, 1>;
template <class P>
using BoundsOf = BasicBounds<typename P::Scalar, P::kVariables, P::kConstraints>;
template <class P>
using WorkspaceOf = typename P::Workspace;

template <class P>
inline constexpr bool kFixedSize = P::kVariables != Dynamic && P::kConstraints != Dynamic;

/// The one branch between small and large problems: a fixed-size matrix where both sizes are constants, else compressed columns.
template <class P>
using JacobianOf =
    std::conditional_t<kFixedSize<P>, Eigen::Matrix<typename P::Scalar, P::kConstraints, P::kVariables>, SparseMatrix>;

namespace detail {
template <class P>
struct HessianType {
  using type = std::conditional_t<kFixedSize<P>, Eigen::Matrix<typename P::Scalar, P::kVariables, P::kVariables>, SparseMatrix>;
};
template <class P>
  requires requires { typename P::Hessian; }
struct HessianType<P> {
  using type = typename P::Hessian;
};
}  // namespace detail

/// As JacobianOf; a fixed-size problem may name a structured type of its own (`using Hessian = PairBlockDiagonal<...>`).
/// Only the lower triangle is written and read.
template <class P>
using HessianOf = typename detail::HessianType<P>::type;

/// What an evaluation writes into: the matrix itself where it is fixed-size, the values of its pattern where it is sparse.
template <class MatrixType>
MatrixType& values_of(MatrixType& matrix) {
  return matrix;
}
inline std::span<double> values_of(SparseMatrix& matrix) {
  return {matrix.valuePtr(), static_cast<std::size_t>(matrix.nonZeros())};
}
template <class MatrixType>
using ValuesOf = decltype(values_of(std::declval<MatrixType&>()));

/// A problem, whether of fixed size (no virtual call, no allocation) or an `Nlp`.
template <class P>
concept NonlinearProgram = requires(const P& problem, const VectorNOf<P>& x, const VectorMOf<P>& lambda, WorkspaceOf<P>& workspace,
                                    BoundsOf<P>& bounds, VectorNOf<P>& gradient, VectorMOf<P>& values,
                                    ValuesOf<JacobianOf<P>> jacobian, ValuesOf<HessianOf<P>> hessian) {
  typename P::Scalar;
  { P::kVariables } -> std::convertible_to<int>;
  { P::kConstraints } -> std::convertible_to<int>;
  { problem.num_variables() } -> std::convertible_to<int>;
  { problem.num_constraints() } -> std::convertible_to<int>;
  { problem.make_workspace() } -> std::same_as<WorkspaceOf<P>>;
  problem.bounds(bounds);
  problem.prepare(x, workspace);
  { problem.objective(x, workspace) } -> std::convertible_to<typename P::Scalar>;
  problem.gradient(x, workspace, gradient);
  problem.constraints(x, workspace, values);
  problem.jacobian(x, workspace, jacobian);
  problem.hessian(x, typename P::Scalar(1), lambda, workspace, hessian);
};

static_assert(NonlinearProgram<Nlp>, "the virtual class satisfies the concept, so that a solver is one template");

}  // namespace tenon
