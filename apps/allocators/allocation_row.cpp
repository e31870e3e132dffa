#include "tenon/apps/allocators/allocation_row.hpp"

#include "tenon/apps/allocators/with_rotors.hpp"

namespace tenon {

std::unique_ptr<AllocationRow> make_allocation_row(const Vehicle& vehicle, const Options& options) {
  return with_rotors(vehicle.num_rotors(), [&](auto rotors) { return make_allocation_row_of_size<rotors>(vehicle, options); });
}

}  // namespace tenon
