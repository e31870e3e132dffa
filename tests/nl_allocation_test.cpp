// A .nl problem, once read, is solved without memory: the AMPL solver library's own is taken with the reading, that of scaling and solver
// with their making. Two solves of one problem, and of one file read twice, are equal bit for bit.
#include <gtest/gtest.h>

#include "tenon/problems/nl/nl_file.hpp"
#include "tenon/solvers/make_solver.hpp"
#include "tenon/tests/allocation_counter.hpp"
#include "tenon/tests/nl_folder.hpp"

namespace tenon {
namespace {

class NlSolve : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (!nl_files_are_available()) GTEST_SKIP() << "built without the AMPL solver library";
  }
};

void expect_equal(const Point& a, const Result& of_a, const Point& b, const Result& of_b) {
  EXPECT_EQ(of_a.status, of_b.status);
  EXPECT_EQ(of_a.iterations, of_b.iterations);
  EXPECT_EQ(a.x, b.x);
  EXPECT_EQ(a.lambda, b.lambda);
  EXPECT_EQ(a.z, b.z);
}

TEST_P(NlSolve, AllocatesNothingAndRepeatsBitForBit) {
  const NlFile file = read_nl(nl_path(GetParam())), again = read_nl(nl_path(GetParam()));
  const auto solver = make_solver("newton-kkt", *file.problem), other = make_solver("newton-kkt", *again.problem);
  Point first = file.start, second = file.start, third = again.start;
  const AllocationCounter of_first;
  const Result one = solver->solve(first);
  EXPECT_EQ(of_first.count(), 0);
  const AllocationCounter of_second;
  const Result two = solver->solve(second);
  EXPECT_EQ(of_second.count(), 0);
  EXPECT_GT(one.iterations, 0);
  expect_equal(first, one, second, two);
  expect_equal(first, one, third, other->solve(third));
}

INSTANTIATE_TEST_SUITE_P(Nl, NlSolve, testing::Values("garden", "garden_binary", "valley", "crossing", "operators", "conflict", "bottomless"),
                         [](const auto& instance) { return std::string(instance.param); });

}  // namespace
}  // namespace tenon
