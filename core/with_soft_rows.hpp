// WithSoftRows: a problem with soft rows as one with hard rows only. A decorator.
//
//     min  f(x) + sum of w (p + n) + q/2 (p^2 + n^2)    s.t.  c_lower <= c(x) - p + n <= c_upper,  p >= 0, n >= 0        for each soft row
//
// p is the excess over the upper side, n the shortfall below the lower one; where a side is absent its slack is held at 0. Stationarity in
// p and n with the multipliers -z_p, -z_n >= 0 of their bounds reads
//
//     w + q p - lambda + z_p = 0,    w + q n + lambda + z_n = 0        so that    -(w + q n) <= lambda <= w + q p                      (1)
//
// with equality where the row is violated: the multiplier is what a violation costs, and never more. So where the hard problem has a
// solution with |lambda| < w, that is the soft one's too, with p = n = 0 (the penalty is exact); else the rows give way at the least price.
// The variables are ordered (x, p_0, n_0, p_1, n_1, ...), soft rows ascending, so that each stage's slacks are together. With w = 0 it is a compliant row with D = 1/q, which needs no slack (nlp.hpp).
#pragma once

#include <vector>

#include "tenon/core/nlp_decorator.hpp"
#include "tenon/core/point.hpp"

namespace tenon {

class WithSoftRows final : public NlpDecorator {
 public:
  /// Refers to the problem, which must outlive this. Throws std::invalid_argument, naming the row, where a weight is negative or not
  /// finite, both are 0, a row is soft twice or does not exist.
  explicit WithSoftRows(const Nlp& problem);

  /// The same point with p and n at the violation of the rows there, and their multipliers by (1); and with them taken away.
  Point lift(const Point& point) const;
  void lower(const Point& lifted, Point& point) const;

  /// What the slacks of this x cost: the part of the objective that the problem itself does not know.
  double price(ConstVectorRef x) const;

  int num_variables() const override { return n_ + 2 * count(); }
  SparsePattern jacobian_pattern() const override;
  Stages stages() const override;
  SparsePattern hessian_pattern() const override;
  void bounds(Bounds& bounds) const override;
  std::vector<SoftRow> soft_rows() const override { return {}; }
  void nominal_values(VectorRef variables, VectorRef rows) const override;
  void initial_point(VectorRef x) const override;
  void prepare(ConstVectorRef x, Workspace& workspace) const override { problem_.prepare(x.head(n_), workspace); }
  double objective(ConstVectorRef x, Workspace& workspace) const override;
  void gradient(ConstVectorRef x, Workspace& workspace, VectorRef gradient) const override;
  void constraints(ConstVectorRef x, Workspace& workspace, VectorRef values) const override;
  void jacobian(ConstVectorRef x, Workspace& workspace, std::span<double> values) const override;
  void hessian(ConstVectorRef x, double sigma, ConstVectorRef lambda, Workspace& workspace, std::span<double> values) const override;
  std::string variable_name(int i) const override;

 private:
  int count() const { return static_cast<int>(soft_.size()); }
  int excess(int k) const { return n_ + 2 * k; }  // the place of p_k, and of n_k
  int shortfall(int k) const { return n_ + 2 * k + 1; }

  std::vector<SoftRow> soft_;  // rows ascending
  int n_, m_;                  // of the problem itself
  Vector linear_, quadratic_;  // w and q of each slack
};

}  // namespace tenon
