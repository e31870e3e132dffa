// The flow of a mode that is known in closed form (Dae::has_exact_flow): one step goes as far as it may.
#pragma once

#include <memory>

#include "tenon/solvers/hybrid/flow.hpp"

namespace tenon {

std::unique_ptr<Flow> make_exact_flow(const Dae& dae);

}  // namespace tenon
