// Multipliers for a point whose library returns none: those that come nearest to balancing the gradient there.
//
//     min over (lambda, z)   | grad f + J' lambda + z |^2      lambda, z >= 0 at active upper sides, <= 0 at active lower ones,
//                                                             free at equalities and fixed variables, 0 elsewhere
//
// A side is active where it is nearer than kActive max(1, |bound|). The answer is judged by the ruler afterwards like any other.
#pragma once

#include "tenon/core/point.hpp"

namespace tenon {

/// x (n) with its least-squares multipliers; with none where something is not finite at x. Evaluates afresh.
Point with_least_squares_multipliers(const Nlp& problem, const Bounds& bounds, const Vector& x);

}  // namespace tenon
