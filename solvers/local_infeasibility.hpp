// What can be read off first-order quantities without multipliers: whether a point is where the violation of the rows gets no smaller.
#pragma once

#include "tenon/core/first_order.hpp"

namespace tenon {

/// How far each row lies above its upper bound (> 0) or below its lower one (< 0).
Vector signed_violation(const Vector& constraints, const Bounds& bounds);

/// Whether x is a stationary point, within the box, of half the squared violation v of the rows, v not 0:
///
///     | P(-J'v) | <= max(1e-3 |J|'|v|, 1e-6 |v|_inf)  in every variable,  P: no component out of the box,  and  |v|_inf > 1e-6
bool is_locally_infeasible(const Vector& x, const Bounds& bounds, const FirstOrder& here);

}  // namespace tenon
