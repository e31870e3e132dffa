// Allocators of N rotors, N known at compile time. CMake makes the sources for each N from newton_allocator.cpp.in
// and back_end_allocator.cpp.in.
#pragma once

#include <memory>
#include <string>

#include "tenon/core/options.hpp"
#include "tenon/problems/allocation/allocator.hpp"
#include "tenon/problems/allocation/vehicle.hpp"

namespace tenon {

/// Newton-KKT on the fixed-size problem: no allocation, no virtual call.
template <int N>
std::unique_ptr<Allocator> make_newton_allocator(const Vehicle& vehicle, const Options& options);

/// The same ticks on a back end of make_solver(), on the problem lifted to an Nlp.
template <int N>
std::unique_ptr<Allocator> make_back_end_allocator(const Vehicle& vehicle, const std::string& solver, const Options& options);

}  // namespace tenon
