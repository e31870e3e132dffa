// The counter that judges "no allocation" is itself judged: it sees every way to the heap, and nothing else.
#include "tenon/tests/allocation_counter.hpp"

#include <cstdlib>
#include <cstring>
#include <functional>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "tenon/core/eigen.hpp"

namespace tenon {
namespace {

/// Keeps the compiler from leaving out an allocation whose result nobody reads.
template <class T>
T* used(T* memory) {
  asm volatile("" : "+r"(memory) : : "memory");
  return memory;
}

long counted(const std::function<void()>& work) {
  const AllocationCounter counter;
  work();
  return counter.count();
}

TEST(AllocationCounter, SeesOperatorNewInAllItsForms) {
  struct alignas(64) Wide {
    double values[8];
  };
  EXPECT_EQ(counted([] { delete used(new int(1)); }), 1);
  EXPECT_EQ(counted([] { delete[] used(new double[100]); }), 1);
  EXPECT_EQ(counted([] { delete used(new Wide()); }), 1);
}

TEST(AllocationCounter, SeesTheFunctionsOfC) {
  EXPECT_EQ(counted([] { std::free(used(std::malloc(10))); }), 1);
  EXPECT_EQ(counted([] { std::free(used(std::calloc(10, 8))); }), 1);
  EXPECT_EQ(counted([] { std::free(used(std::aligned_alloc(64, 128))); }), 1);
  EXPECT_EQ(counted([] { std::free(used(std::realloc(used(std::malloc(10)), 10000))); }), 2);
  EXPECT_EQ(counted([] {
              void* memory = nullptr;
              ASSERT_EQ(posix_memalign(&memory, 64, 100), 0);
              std::free(used(memory));
            }),
            1);
}

TEST(AllocationCounter, SeesWhatALibraryAllocates) {
  EXPECT_EQ(counted([] { std::free(used(strdup("inside the C library"))); }), 1);
  EXPECT_EQ(counted([] {
              Vector vector = Vector::Zero(100);
              used(&vector);
            }),
            1);
}

TEST(AllocationCounter, SeesNothingWhereNothingIsAllocated) {
  std::vector<double> values(100);
  Eigen::Vector3d a(1, 2, 3), b = a;
  EXPECT_EQ(counted([&] {
              for (double& value : values) value += a.dot(b);
              values.clear();
              values.resize(100);
            }),
            0);
}

TEST(AllocationCounter, DoesNotSeeOtherThreads) {
  std::vector<int> far;
  long there = -1;
  std::thread other;
  const AllocationCounter counter;
  other = std::thread([&] { there = counted([&] { far.resize(1000); }); });
  const long here = counter.count();
  other.join();
  EXPECT_EQ(there, 1);
  EXPECT_LE(here, 2);  // what std::thread itself needs
  EXPECT_EQ(counter.count(), here);
}

}  // namespace
}  // namespace tenon
