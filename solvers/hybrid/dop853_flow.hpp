// DOP853: an explicit Runge-Kutta method of order 8 on xdot = f(t, x), y = g(t, x), which a DAE of index 1 is once F is solved for (xdot,
// y).
//
// A one-step method: after an event it goes on at full order and with its step, which is why it is the default for hybrid systems.
//
//     k_i = f(t + c_i h, x + h sum_j a_ij k_j),    x+ = x + h sum_j b_j k_j,    err = h |e5| |e5| / sqrt(|e5|^2 + 0.01 |e3|^2)
//
// Source: E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary Differential Equations I, 2nd ed. (1993), sec. II.5 and II.6.
#pragma once

#include <memory>

#include "tenon/solvers/hybrid/flow.hpp"

namespace tenon {

std::unique_ptr<Flow> make_dop853_flow(const Dae& dae, const IntegratorOptions& options);

}  // namespace tenon
