#include "talus/simulate/plan/work_order.hpp"

#include <gtest/gtest.h>

#include "support/scenes.hpp"
#include "talus/simulate/plan/region.hpp"

namespace talus {
namespace {

TEST(WorkOrder, FollowsTheZOfTheSquaresAndTheNumbersWithin) {
  const Grid grid = test::grid_of(4 * kRegionSide, 4 * kRegionSide, 2.0, 3.0);
  // Squares (east, north), two cells each, numbered row by row from the north-west as a layer would be.
  std::vector<SourceCell> sources;
  std::vector<std::pair<int, int>> square;
  for (int north = 3; north >= 0; --north)
    for (int east = 0; east < 4; ++east)
      for (const double inside : {0.1, 0.9}) {
        sources.push_back({0, (east + inside) * kRegionSide * 2.0, (north + inside) * kRegionSide * 3.0});
        square.emplace_back(east, north);
      }
  const std::pair<int, int> z[16] = {{0, 0}, {1, 0}, {0, 1}, {1, 1}, {2, 0}, {3, 0}, {2, 1}, {3, 1},
                                     {0, 2}, {1, 2}, {0, 3}, {1, 3}, {2, 2}, {3, 2}, {2, 3}, {3, 3}};
  const std::vector<std::uint32_t> order = work_order(grid, sources);
  ASSERT_EQ(order.size(), sources.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    EXPECT_EQ(square[order[i]], z[i / 2]) << i;
    if (i % 2 == 1) EXPECT_EQ(order[i], order[i - 1] + 1);
  }
}

}  // namespace
}  // namespace talus
