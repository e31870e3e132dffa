// What a solve says beside its point. Scalars only, so that returning it allocates nothing.
#pragma once

#include "tenon/core/kkt_residual.hpp"
#include "tenon/core/status.hpp"

namespace tenon {

struct Result {
  Status status = Status::numerical_failure;
  int iterations = 0;
  double objective = 0;   // f(x) at the returned point
  KktResidual residual;   // at the returned point, by the independent ruler
  double elapsed = 0;     // s, the solve alone
};

}  // namespace tenon
