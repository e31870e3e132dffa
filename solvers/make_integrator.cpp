#include "tenon/solvers/make_integrator.hpp"

#include <stdexcept>

#include "tenon/core/nearest_name.hpp"
#include "tenon/solvers/hybrid/hybrid_integrator.hpp"
#include "tenon/solvers/hybrid/runge_kutta_flow.hpp"
#include "tenon/solvers/ida/ida_flow.hpp"

namespace tenon {

std::vector<IntegratorDescription> list_integrators() {
  const std::string ida = ida_version();
  return {{"dop853", "explicit Runge-Kutta of order 8 on the DAE solved for its derivatives, one step", true},
          {"dopri5", "the same of order 5, for systems that a clock samples", true},
          {"ida", "implicit BDF of order 1 to 5, " + (ida.empty() ? "SUNDIALS" : ida), !ida.empty()}};
}

std::unique_ptr<Integrator> make_integrator(const std::string& name, const Dae& dae, const IntegratorOptions& options) {
  validate(options);
  if (name == "dop853") return std::make_unique<HybridIntegrator>(dae, options, make_dop853_flow(dae, options));
  if (name == "dopri5") return std::make_unique<HybridIntegrator>(dae, options, make_dopri5_flow(dae, options));
  if (name == "ida") return std::make_unique<HybridIntegrator>(dae, options, make_ida_flow(dae, options));
  throw std::invalid_argument("unknown integrator \"" + name + "\", the nearest is \"" + nearest_name(name, {"dop853", "dopri5", "ida"}) +
                              "\" (expected dop853, dopri5 or ida)");
}

}  // namespace tenon
