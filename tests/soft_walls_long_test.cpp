// All 200 random starts of the pole between soft walls, beside exhaustive search. Recorded: the table stands in soft_walls.md.
#include <gtest/gtest.h>

#include <cstdio>

#include "tenon/tests/soft_walls_runs.hpp"

namespace tenon::soft_walls {
namespace {

TEST(SoftWallsLong, WhereverExhaustiveSearchArrivesTheLoopDoes) {
  constexpr std::uint64_t kStarts = 200;
  int by_search = 0, by_five = 0, by_ten = 0, beyond_ten = 0;
  double dearest = 0;
  for (std::uint64_t seed = 1; seed <= kStarts; ++seed) {
    const Outcome reference = reference_in_world(seed, 5);
    if (!reference.arrived) continue;
    ++by_search;
    const Outcome five = run_in_world(seed, 5), ten = run_in_world(seed, 10);
    EXPECT_TRUE(five.arrived) << "world " << seed << ", N = 5";
    EXPECT_LE(five.cost, 1.05 * reference.cost) << "world " << seed;
    by_five += five.arrived;
    by_ten += ten.arrived;
    dearest = std::max(dearest, five.cost / reference.cost);
    if (ten.arrived) continue;
    // A horizon of 10 has a law of its own: where that law itself does not arrive, no solver of it can.
    ++beyond_ten;
    EXPECT_FALSE(reference_in_world(seed, 10).arrived) << "world " << seed << ", N = 10";
  }
  EXPECT_GT(by_search, 50);
  std::printf("of %d starts search arrives from %d; N = 5: %d, cost at most %.4f times; N = 10: %d, its own search neither: %d\n",
              static_cast<int>(kStarts), by_search, by_five, dearest, by_ten, beyond_ten);
}

}  // namespace
}  // namespace tenon::soft_walls
