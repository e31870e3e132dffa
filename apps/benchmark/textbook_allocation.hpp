// The published allocation algorithm, as the yardstick of ours: Newton's method on the KKT conditions, the 18 x 18 system dense.
//
//     [ H   J' ] [ dx ]     [ grad O ]        factor = min(1, du_max/|du|, da_max/|da|),  x += factor dx,  l += factor (l+ - l)
//     [ J   0  ] [ l+ ] = - [ G      ]        until |G|_2 < tol and |O_before - O| / O_before < tol, at most 16 times
//
// Soft limits, warm start from the tick before, linear solution where it fails: the MOMAV controller notes. Evaluations are those of
// WrenchAllocation, so that what is compared is the algorithm and its linear algebra.
#pragma once

#include "tenon/core/point.hpp"
#include "tenon/problems/allocation/linear_allocation.hpp"
#include "tenon/problems/allocation/wrench_allocation.hpp"

namespace tenon {

class TextbookAllocator final : public Allocator {
 public:
  /// Throws std::invalid_argument where the vehicle has not 6 rotors. Its limits are taken as soft.
  explicit TextbookAllocator(Vehicle vehicle);

  void reset() override { has_previous_ = false; }
  void reset(ConstVectorRef angles) override;
  const Allocation& allocate(const Wrench& wrench, double dt) override;
  void fail_rotor(int i) override;
  void stick_servo(int i) override;

 private:
  static constexpr int kRotors = 6, kSize = 2 * kRotors + 6;
  using Problem = WrenchAllocation<kRotors>;

  bool iterate();
  void evaluate();
  void step();

  LinearAllocation linear_;
  Problem problem_;
  Problem::Workspace at_;
  PointOf<Problem> point_;
  double objective_ = 0;
  VectorNOf<Problem> gradient_;
  Wrench g_;
  JacobianOf<Problem> jacobian_;
  Problem::Hessian hessian_;
  Eigen::Matrix<double, kSize, kSize> k_;
  Eigen::Matrix<double, kSize, 1> rhs_;
  Eigen::LDLT<Eigen::Matrix<double, kSize, kSize>> ldlt_;
  Vector u_linear_, a_linear_, previous_;
  bool has_previous_ = false, has_point_ = false;
  Allocation out_;
};

}  // namespace tenon
