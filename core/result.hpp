// What a solve says beside its point. Scalars only, so that returning it allocates nothing.
#pragma once

#include <optional>

#include "tenon/core/kkt_residual.hpp"
#include "tenon/core/status.hpp"

namespace tenon {

struct Result {
  Status status = Status::numerical_failure;
  int iterations = 0;
  double objective = 0;   // f(x) at the returned point
  KktResidual residual;   // at the returned point, by the independent ruler
  std::optional<KktResidual> scaled_residual;  // of the scaled problem, where the solver scaled it: `solved` then speaks of this one
  double elapsed = 0;     // s, the solve alone
};

}  // namespace tenon
