// What first-order conditions are made of, at one x, and what can be read off it without multipliers.
#pragma once

#include "tenon/core/nlp.hpp"

namespace tenon {

struct FirstOrder {
  double objective;
  Vector gradient;        // n
  Vector constraints;     // m
  SparseMatrix jacobian;  // m x n

  /// Evaluates afresh. Allocates.
  FirstOrder(const Nlp& problem, const Vector& x);

  bool all_finite() const;
};

/// How far each row lies above its upper bound (> 0) or below its lower one (< 0).
Vector signed_violation(const Vector& constraints, const Bounds& bounds);

/// Whether x is a stationary point, within the box, of half the squared violation v of the rows, v not 0:
///
///     | P(-J'v) | <= max(1e-3 |J|'|v|, 1e-6 |v|_inf)  in every variable,  P: no component out of the box,  and  |v|_inf > 1e-6
bool is_locally_infeasible(const Vector& x, const Bounds& bounds, const FirstOrder& here);

}  // namespace tenon
