// A primal-dual iterate of the interior-point method, and the step from one to the next.
#pragma once

#include "tenon/core/nlp.hpp"
#include "tenon/solvers/newton_kkt/barrier_box.hpp"

namespace tenon {

/// What the Newton system is about: variables, slacks, and their multipliers.
template <class P>
struct Step {
  using Scalar = typename P::Scalar;

  VectorNOf<P> x;       // n
  VectorMOf<P> s;       // m: slack of each row
  VectorMOf<P> lambda;  // m
  BoxSides<Scalar, P::kVariables> zx;
  BoxSides<Scalar, P::kConstraints> zs;

  Step(int n, int m) {
    x.setZero(n);
    s.setZero(m);
    lambda.setZero(m);
    zx.lower.setZero(n), zx.upper.setZero(n);
    zs.lower.setZero(m), zs.upper.setZero(m);
  }
};

template <class P>
struct Iterate : Step<P> {
  typename P::Scalar objective = 0;
  VectorMOf<P> constraints;  // m: c(x)

  Iterate(int n, int m) : Step<P>(n, m) { constraints.setZero(m); }
};

/// Whether every entry is a finite number: 0 v is 0 for no other. As a sum it runs in vector registers, which Eigen's allFinite does not.
bool all_finite(const auto& v) {
  using Scalar = typename std::decay_t<decltype(v)>::Scalar;
  return (v.array() * Scalar(0)).sum() == 0;
}

/// Bound multipliers of `to` = those of `from` + alpha times the step's.
template <class P>
void take_dual_step(const Iterate<P>& from, const Step<P>& step, typename P::Scalar alpha, Iterate<P>& to) {
  to.zx.lower = from.zx.lower + alpha * step.zx.lower;
  to.zx.upper = from.zx.upper + alpha * step.zx.upper;
  to.zs.lower = from.zs.lower + alpha * step.zs.lower;
  to.zs.upper = from.zs.upper + alpha * step.zs.upper;
}

}  // namespace tenon
