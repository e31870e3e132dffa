// One tick of an allocation as a problem on its own: what a comparison puts before every solver.
//
// The same problem stands in two forms, of fixed size (arm-block linear algebra, no virtual call) and lifted to an Nlp, which every back end
// takes. N is known at compile time inside; CMake makes one source for each N from allocation_row.cpp.in.
#pragma once

#include <memory>

#include "tenon/apps/measure.hpp"
#include "tenon/core/nlp.hpp"
#include "tenon/problems/allocation/allocator.hpp"
#include "tenon/problems/allocation/vehicle.hpp"

namespace tenon {

class AllocationRow {
 public:
  virtual ~AllocationRow() = default;

  /// Wanted wrench (body axes), angles (N, rad) of the tick before and the time since (s).
  virtual void set(const Wrench& wrench, ConstVectorRef previous, double dt) = 0;

  virtual const Nlp& lifted() const = 0;

  /// Newton-KKT on the fixed-size form, measured as measure() does the others.
  virtual Measurement measure_fixed_size(const Point& start, int timed_runs) = 0;
};

/// `options` are those of measure_fixed_size().
std::unique_ptr<AllocationRow> make_allocation_row(const Vehicle& vehicle, const Options& options);

template <int N>
std::unique_ptr<AllocationRow> make_allocation_row_of_size(const Vehicle& vehicle, const Options& options);

}  // namespace tenon
