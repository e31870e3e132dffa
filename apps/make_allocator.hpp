// The allocators by name: what `tenon allocate --solver NAME` takes.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tenon/core/options.hpp"
#include "tenon/problems/allocation/allocator.hpp"
#include "tenon/problems/allocation/vehicle.hpp"

namespace tenon {

/// Which solver `allocate` takes where neither the command line nor the vehicle names one.
std::string default_allocator();

/// The names that make_allocator takes, "pseudo-inverse" among them.
std::vector<std::string> list_allocators();

/// Throws std::invalid_argument for an unknown name (the nearest is named) and for options that make no sense.
std::unique_ptr<Allocator> make_allocator(const Vehicle& vehicle, const std::string& solver, const Options& options);

}  // namespace tenon
