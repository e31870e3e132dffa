// The same count where the address sanitizer owns the allocation functions: it calls a hook at each.
#include "tenon/tests/allocation_counter.hpp"

#include <cstddef>

// From <sanitizer/allocator_interface.h>, which GCC does not install.
extern "C" int __sanitizer_install_malloc_and_free_hooks(void (*on_malloc)(const volatile void* memory, std::size_t size),
                                                         void (*on_free)(const volatile void* memory));

namespace {

constinit thread_local long allocations = 0;

[[maybe_unused]] const int installed =
    __sanitizer_install_malloc_and_free_hooks([](const volatile void*, std::size_t) { ++allocations; }, [](const volatile void*) {});

}  // namespace

long tenon::AllocationCounter::total() { return allocations; }
