// Every integrator by name, behind one face.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tenon/core/integrator.hpp"

namespace tenon {

struct IntegratorDescription {
  std::string name;         // as on the command line
  std::string description;  // one line: method, library and its version
  bool available = false;   // false: its library was absent when this was built
};

std::vector<IntegratorDescription> list_integrators();

/// An integrator of `dae`, which must outlive it. Throws std::invalid_argument for an unknown name (the nearest is named), for one that is
/// not available, and for options that make no sense.
std::unique_ptr<Integrator> make_integrator(const std::string& name, const Dae& dae, const IntegratorOptions& options = {});

}  // namespace tenon
