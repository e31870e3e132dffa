// Rows whose gradients are linearly dependent at a point: where the Jacobian of what is active loses rank, multipliers are not unique.
//
//     J_a' P = Q [ R_11  R_12 ]       J_a: gradients of the active rows by the variables that are off their bounds, each of length 1
//                [  0     0   ]       gradient of row P_k, k > rank, is the sum of (R_11^-1 R_12)_ik times that of row P_i
#pragma once

#include <vector>

#include "tenon/core/nlp.hpp"

namespace tenon {

/// One row that the others make superfluous, or contradict, to first order.
struct DependentRow {
  int row;
  std::vector<int> on;  // the rows of which its gradient is a combination; empty where the gradient is 0
};

/// Every dependent row at x, by a rank-revealing sparse QR factorisation: relative threshold 1e-8. Empty where something is not finite.
std::vector<DependentRow> dependent_rows(const Nlp& problem, const Vector& x);

}  // namespace tenon
