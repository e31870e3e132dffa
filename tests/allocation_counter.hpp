// Counts what the current thread asks of the heap: every malloc and its kin, not only operator new.
//
//     AllocationCounter counter;
//     solver.solve(point);
//     EXPECT_EQ(counter.count(), 0);
//
// A test links to one of two sources: allocation_counter.cpp stands in front of the C library's functions; in a build with the address
// sanitizer, which stands there itself, allocation_counter_asan.cpp is called by it.
#pragma once

namespace tenon {

class AllocationCounter {
 public:
  AllocationCounter() : start_(total()) {}

  /// Allocations (and reallocations) by this thread since this counter was made.
  long count() const { return total() - start_; }

 private:
  static long total();

  long start_;
};

}  // namespace tenon
