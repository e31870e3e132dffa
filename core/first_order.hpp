// What first-order conditions are made of, at one x.
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

}  // namespace tenon
