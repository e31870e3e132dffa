// In place of ida_flow.cpp where SUNDIALS was absent at the time of the build, or not wanted.
#include <stdexcept>

#include "tenon/solvers/ida/ida_flow.hpp"

namespace tenon {

std::string ida_version() {
  return "";
}

std::unique_ptr<Flow> make_ida_flow(const Dae&, const IntegratorOptions&) {
  throw std::invalid_argument("integrator \"ida\" is not available: SUNDIALS was absent when tenon was built");
}

}  // namespace tenon
