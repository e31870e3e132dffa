// Where iterates begin: cold, warm, recentred, or at a restored x.  newton_kkt.md, sections 8 and 9
#pragma once

#include "tenon/solvers/newton_kkt/newton_system.hpp"

namespace tenon {

template <class Scalar>
inline constexpr Scalar kColdPush = Scalar(1e-2);  // kappa_1 = kappa_2 of [WB06, sec. 3.6]
template <class Scalar>
inline constexpr Scalar kWarmPush = Scalar(1e-6);

/// Slacks at their rows' values, inside their bounds.
template <class P>
void follow_rows(const BarrierProblem<P>& barrier, typename P::Scalar push, Iterate<P>& at) {
  const auto& box = barrier.s_box();
  at.s = (box.free_mask() > 0).select(at.constraints, barrier.bounds().c_lower);
  box.push_inside(at.s.array(), push, push);
}

/// x and slacks moved inside, everything evaluated. False where the problem cannot be evaluated there.
template <class P>
bool begin_inside(BarrierProblem<P>& barrier, typename P::Scalar push, Iterate<P>& at) {
  barrier.x_box().push_inside(at.x.array(), push, push);
  if (!barrier.evaluate(at)) return false;
  follow_rows(barrier, push, at);
  return barrier.linearise(at);
}

/// Bound multipliers 1, lambda least squares.
template <class P, class Kkt>
void cold_multipliers(BarrierProblem<P>& barrier, NewtonSystem<P, Kkt>& system, Iterate<P>& at) {
  barrier.x_box().fill(at.zx, 1);
  barrier.s_box().fill(at.zs, 1);
  if (!system.least_squares_multipliers(barrier, at)) at.lambda.setZero();
  barrier.update_stationarity(at);
}

/// The guess's multipliers, at least mu / distance.
template <class P>
void warm_multipliers(const BarrierProblem<P>& barrier, const PointOf<P>& guess, typename P::Scalar mu, Iterate<P>& at) {
  barrier.x_box().split(guess.z.array(), mu, at.zx);
  barrier.s_box().split(guess.lambda.array(), mu, at.zs);
}

/// From `at`, moved inside, on the central path of mu, lambda kept. `spare` is overwritten.
template <class P>
void recentre(BarrierProblem<P>& barrier, typename P::Scalar mu, Iterate<P>& at, Iterate<P>& spare) {
  spare.x = at.x;
  if (!begin_inside(barrier, kColdPush<typename P::Scalar>, at)) {  // the inside cannot be evaluated: stay
    at.x = spare.x;
    begin_inside(barrier, typename P::Scalar(0), at);
  }
  barrier.centre(mu, at);
}

/// At the x of a restoration, on the central path of mu, lambda least squares. False where the problem cannot be evaluated there.
template <class P, class Kkt>
bool begin_at_restored(BarrierProblem<P>& barrier, NewtonSystem<P, Kkt>& system, const VectorNOf<P>& x, typename P::Scalar mu,
                       Iterate<P>& at) {
  at.x = x;
  at.lambda.setZero();
  if (!barrier.evaluate(at)) return false;
  follow_rows(barrier, kColdPush<typename P::Scalar>, at);
  barrier.linearise(at);
  barrier.centre(mu, at);
  if (!system.least_squares_multipliers(barrier, at)) at.lambda.setZero();
  barrier.update_stationarity(at);
  return true;
}

}  // namespace tenon
