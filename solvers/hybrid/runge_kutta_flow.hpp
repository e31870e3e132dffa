// Explicit Runge-Kutta methods on xdot = f(t, x), y = g(t, x), which a DAE of index 1 is once F is solved for (xdot, y).
//
//     k_i = f(t + c_i h, x + h sum_j a_ij k_j),    x+ = x + h sum_j b_j k_j
//
// One-step methods: after an event they go on at full order and with their step, which suits hybrid systems. DOP853, of order 8, is the
// default; where a clock cuts steps short before accuracy does, DOPRI5, of order 5, costs half of it.
//
// Source: E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary Differential Equations I, 2nd ed. (1993), sec. II.4 to II.6.
#pragma once

#include <memory>

#include "tenon/solvers/hybrid/flow.hpp"

namespace tenon {

/// Where the row of stage i begins in a method's kA.
constexpr int row_of(int i) {
  return i * (i - 1) / 2;
}

std::unique_ptr<Flow> make_dop853_flow(const Dae& dae, const IntegratorOptions& options);
std::unique_ptr<Flow> make_dopri5_flow(const Dae& dae, const IntegratorOptions& options);

}  // namespace tenon
