// WithSlacks: a problem with compliant rows as one with hard rows only, for back ends that know no compliance. A decorator.
//
//     c_lower <= c(x) - e <= c_upper,  e = D (lambda - preload)          becomes, with one free variable e for each compliant row,
//
//     min  f(x) + sum e^2/(2 D) + preload e    s.t.   c_lower <= c(x) - e <= c_upper
//
// whose stationarity in e reads e/D + preload - lambda = 0: the same rows, the same multipliers. The variables are ordered (x, e).
#pragma once

#include <vector>

#include "tenon/core/point.hpp"

namespace tenon {

class WithSlacks final : public Nlp {
 public:
  /// Refers to the problem, which must outlive this. The rows that are compliant now get their slack.
  explicit WithSlacks(const Nlp& problem);

  /// Reads compliance and preload again, as they stand at the start of a solve. A row may have become hard (its slack is then held at 0).
  /// Throws std::invalid_argument, naming it, where a row without a slack has become compliant, and where bounds make no sense.
  void update();

  /// The same point with e = D (lambda - preload) added, and with it taken away.
  Point lift(const Point& point) const;
  void lower(const Point& lifted, Point& point) const;

  int num_variables() const override { return n_ + num_slacks(); }
  int num_constraints() const override { return m_; }
  SparsePattern jacobian_pattern() const override;
  SparsePattern hessian_pattern() const override;
  void bounds(Bounds& bounds) const override;
  void initial_point(VectorRef x) const override;
  Workspace make_workspace() const override { return problem_.make_workspace(); }
  void prepare(ConstVectorRef x, Workspace& workspace) const override { problem_.prepare(x.head(n_), workspace); }
  double objective(ConstVectorRef x, Workspace& workspace) const override;
  void gradient(ConstVectorRef x, Workspace& workspace, VectorRef gradient) const override;
  void constraints(ConstVectorRef x, Workspace& workspace, VectorRef values) const override;
  void jacobian(ConstVectorRef x, Workspace& workspace, std::span<double> values) const override;
  void hessian(ConstVectorRef x, double sigma, ConstVectorRef lambda, Workspace& workspace, std::span<double> values) const override;

  std::string name() const override { return problem_.name(); }
  std::string variable_name(int i) const override;
  std::string constraint_name(int j) const override { return problem_.constraint_name(j); }

 private:
  int num_slacks() const { return static_cast<int>(rows_.size()); }

  const Nlp& problem_;
  int n_, m_;               // of the problem itself
  std::vector<int> rows_;   // the row of each slack, ascending
  Vector stiffness_;        // 1/D of each slack, 0 where the row is hard now
  Vector preload_;          // of each slack
};

/// Whether any row of the problem is compliant now.
bool has_compliant_rows(const Nlp& problem);

}  // namespace tenon
