// The filter of the line search on its own.
#include "tenon/solvers/newton_kkt/filter.hpp"

#include <gtest/gtest.h>

namespace tenon {
namespace {

TEST(Filter, AcceptsAllWhileEmpty) {
  Filter<double> filter;
  EXPECT_EQ(filter.size(), 0);
  EXPECT_TRUE(filter.accepts(1e30, 1e30));
}

TEST(Filter, RejectsAPointItHasSeen) {
  Filter<double> filter;
  filter.add(2, 3);
  EXPECT_FALSE(filter.accepts(2, 3));
  EXPECT_FALSE(filter.accepts(2, 4));
  EXPECT_FALSE(filter.accepts(3, 3));
}

TEST(Filter, RejectsAPointItHasSeenWhereNothingIsViolated) {
  Filter<double> filter;
  filter.add(0, 3);
  EXPECT_FALSE(filter.accepts(0, 3));
  EXPECT_TRUE(filter.accepts(0, 2.9));
}

TEST(Filter, AcceptsWhatIsBetterByTheMarginInOneOfTheTwo) {
  Filter<double> filter;
  filter.add(2, 3);
  EXPECT_TRUE(filter.accepts(2 * (1 - 1.1e-5), 100));
  EXPECT_FALSE(filter.accepts(2 * (1 - 0.9e-5), 100));
  EXPECT_TRUE(filter.accepts(100, 3 - 2 * 1.1e-6));
  EXPECT_FALSE(filter.accepts(100, 3 - 2 * 0.9e-6));
}

TEST(Filter, DropsEntriesThatANewOneDominates) {
  Filter<double> filter;
  filter.add(4, 1);
  filter.add(3, 2);
  filter.add(1, 5);
  EXPECT_EQ(filter.size(), 3);
  filter.add(2, 0.5);  // stands before the first two
  EXPECT_EQ(filter.size(), 2);
  EXPECT_FALSE(filter.accepts(4, 1));
  EXPECT_FALSE(filter.accepts(1, 5));
  EXPECT_TRUE(filter.accepts(1.5, 4));
}

TEST(Filter, ForgetsTheOldestWhereItIsFull) {
  Filter<double> filter;
  const auto theta = [](int k) { return 1000.0 - k; };
  const auto phi = [](int k) { return 1.0 * k; };
  int k = 0;
  for (int size = -1; filter.size() > size; ++k) {  // until an entry no longer adds to the size
    size = filter.size();
    filter.add(theta(k), phi(k));
  }
  const int capacity = filter.size();
  EXPECT_EQ(k, capacity + 1) << "one more than it holds";
  EXPECT_TRUE(filter.accepts(theta(0), phi(0))) << "the oldest is forgotten";
  for (int kept = 1; kept < k; ++kept) EXPECT_FALSE(filter.accepts(theta(kept), phi(kept))) << kept;
}

TEST(Filter, IsEmptyAfterClear) {
  Filter<double> filter;
  filter.add(1, 1);
  filter.clear();
  EXPECT_EQ(filter.size(), 0);
  EXPECT_TRUE(filter.accepts(1, 1));
}

}  // namespace
}  // namespace tenon
