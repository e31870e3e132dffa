#include "tenon/apps/make_allocator.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <stdexcept>

#include "tenon/core/nearest_name.hpp"
#include "tenon/problems/allocation/pseudo_inverse.hpp"

namespace tenon {

std::string default_allocator() {
  return "pseudo-inverse";
}

std::vector<std::string> list_allocators() {
  return {"pseudo-inverse"};
}

std::unique_ptr<Allocator> make_allocator(const Vehicle& vehicle, const std::string& solver, const Options& options) {
  validate(options);
  if (solver == "pseudo-inverse") return std::make_unique<PseudoInverse>(vehicle);
  throw std::invalid_argument(fmt::format("unknown solver '{}', the nearest is '{}' (expected one of {})", solver,
                                          nearest_name(solver, list_allocators()), fmt::join(list_allocators(), ", ")));
}

}  // namespace tenon
