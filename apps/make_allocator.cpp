#include "tenon/apps/make_allocator.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

#include "tenon/apps/allocators/allocators_of_size.hpp"
#include "tenon/apps/allocators/with_rotors.hpp"
#include "tenon/core/nearest_name.hpp"
#include "tenon/problems/allocation/pseudo_inverse.hpp"
#include "tenon/solvers/make_solver.hpp"

namespace tenon {

namespace {

constexpr const char* kNewtonKkt = "newton-kkt";          // on the fixed-size problem
constexpr const char* kNewtonKktSparse = "newton-kkt-sparse";  // the same loop on the lifted problem
constexpr const char* kPseudoInverse = "pseudo-inverse";

}  // namespace

std::string default_allocator() { return kNewtonKkt; }

std::vector<std::string> list_allocators() {
  std::vector<std::string> names{kNewtonKkt, kNewtonKktSparse, kPseudoInverse};
  for (const SolverDescription& solver : list_solvers()) {
    if (solver.available && solver.name != kNewtonKkt) names.push_back(solver.name);
  }
  return names;
}

std::unique_ptr<Allocator> make_allocator(const Vehicle& vehicle, const std::string& solver, const Options& options) {
  validate(options);
  const std::vector<std::string> names = list_allocators();
  if (std::ranges::find(names, solver) == names.end()) {
    throw std::invalid_argument(fmt::format("unknown solver '{}', the nearest is '{}' (expected one of {})", solver,
                                            nearest_name(solver, names), fmt::join(names, ", ")));
  }
  if (solver == kPseudoInverse) return std::make_unique<PseudoInverse>(vehicle);
  return with_rotors(vehicle.num_rotors(), [&](auto rotors) {
    if (solver == kNewtonKkt) return make_newton_allocator<rotors>(vehicle, options);
    return make_back_end_allocator<rotors>(vehicle, solver == kNewtonKktSparse ? kNewtonKkt : solver, options);
  });
}

}  // namespace tenon
