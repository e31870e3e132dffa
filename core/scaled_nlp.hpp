// ScaledNlp: the same problem in other units, so that a tolerance means the same in every row. A decorator.
//
//     x^ = x / d_x,   f^ = s f,   c^ = d_c c           lambda = d_c lambda^ / s,   z = z^ / (s d_x)
//
// Factors: d_x and 1/d_c are the problem's nominal values where it states them. A row without one, and the objective, are scaled down where
// their largest derivative by x^ exceeds g = 10 [WB06, eq. 40, where g = 100; 10 took a fifth less iterations on 54 Hock-Schittkowski
// problems, and lost none]:
//
//     d_c,j = max(1e-8, min(1, g / |d_x grad c_j|_inf)),   s = max(1e-8, min(1, g / |d_x grad f|_inf))
//
// Nothing is scaled up: a small derivative at one point says nothing of the next. All factors are powers of two: scaling rounds nothing.
#pragma once

#include <vector>

#include "tenon/core/nlp_decorator.hpp"
#include "tenon/core/point.hpp"

namespace tenon {

class ScaledNlp final : public NlpDecorator {
 public:
  /// Takes the nominal values; every other factor is 1 until choose().
  /// Throws std::invalid_argument, naming variable or row, where a nominal value is negative or not finite.
  explicit ScaledNlp(const Nlp& problem);

  /// Chooses the factors of what has no nominal value, by the derivatives of the problem itself at one point, values in the order of the
  /// pattern. Where a derivative is not finite its function stays as it is. Allocates nothing.
  void choose(const Vector& gradient, std::span<const double> jacobian);

  /// Whether some row had no derivative there (a product of variables that start at 0): it is then judged by its derivatives elsewhere.
  bool has_flat_rows() const;
  void choose_flat_rows(std::span<const double> jacobian);

  /// Whether every factor is 1.
  bool is_identity() const { return identity_; }
  /// The smallest of s and d_c: residuals in the problem's own units are at most the scaled ones divided by it, where d_x >= 1.
  double smallest_factor() const;

  double objective_factor() const { return s_; }          // s
  const Vector& variable_factors() const { return dx_; }  // d_x, n
  const Vector& row_factors() const { return dc_; }       // d_c, m

  /// A point of the problem itself becomes one of the scaled problem, and back.
  void scale(Point& point) const;
  void unscale(Point& point) const;

  void bounds(Bounds& bounds) const override;
  void nominal_values(VectorRef, VectorRef) const override {}
  void initial_point(VectorRef x) const override;
  Workspace make_workspace() const override;
  void prepare(ConstVectorRef x, Workspace& workspace) const override;
  double objective(ConstVectorRef x, Workspace& workspace) const override;
  void gradient(ConstVectorRef x, Workspace& workspace, VectorRef gradient) const override;
  void constraints(ConstVectorRef x, Workspace& workspace, VectorRef values) const override;
  void jacobian(ConstVectorRef x, Workspace& workspace, std::span<double> values) const override;
  void hessian(ConstVectorRef x, double sigma, ConstVectorRef lambda, Workspace& workspace, std::span<double> values) const override;

 private:
  struct ScaledScratch final : Scratch {
    Workspace problem;
    Vector x, lambda;  // in the problem's own units
  };
  static ScaledScratch& scaled(Workspace& workspace) { return static_cast<ScaledScratch&>(*workspace); }
  void measure_rows(std::span<const double> jacobian, Vector& largest) const;
  void update_entries();

  const SparsePattern jacobian_pattern_, hessian_pattern_;
  double s_ = 1;
  Vector dx_, dc_;              // n, m
  Vector largest_, elsewhere_;  // m: the largest derivative of each row
  std::vector<bool> stated_;    // m: the row has a nominal value
  Vector jacobian_, hessian_;   // the factor of each entry of the patterns: d_c,i d_x,j and d_x,i d_x,j
  bool identity_ = true;
};

}  // namespace tenon
