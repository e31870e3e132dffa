// The same count where the address sanitizer owns the allocation functions: it calls a hook at each.
#include "tenon/tests/allocation_counter.hpp"

#include <cstddef>

#include <sanitizer/allocator_interface.h>

namespace {

constinit thread_local long allocations = 0;

[[maybe_unused]] const int installed =
    __sanitizer_install_malloc_and_free_hooks([](const volatile void*, std::size_t) { ++allocations; }, [](const volatile void*) {});

}  // namespace

long tenon::AllocationCounter::total() { return allocations; }
