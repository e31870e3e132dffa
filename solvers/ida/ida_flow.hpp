// SUNDIALS IDA on F(t, xdot, x, y) = 0: variable-order BDF of order 1 to 5, for stiff modes and large sparse systems.
//
// The analytic Jacobian dF/d(x, y) + alpha dF/dxdot goes to a dense LU, or to KLU where its pattern is sparse. Events are
// HybridIntegrator's. Source: A. C. Hindmarsh et al., SUNDIALS: Suite of nonlinear and differential/algebraic equation solvers, ACM TOMS 31
// (2005).
#pragma once

#include <memory>
#include <string>

#include "tenon/solvers/hybrid/flow.hpp"

namespace tenon {

/// Name and version of the library, empty where it was absent at the time of the build.
std::string ida_version();

/// Throws std::invalid_argument where the library was absent when tenon was built.
std::unique_ptr<Flow> make_ida_flow(const Dae& dae, const IntegratorOptions& options);

}  // namespace tenon
