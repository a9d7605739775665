#include "talus/simulate/plan/region.hpp"

#include <gtest/gtest.h>

#include <set>

#include "support/scenes.hpp"

namespace talus {
namespace {

/// 130 x 65 cells: 3 x 2 regions, the last ones of 2 columns and of 1 row.
TEST(Regions, EachCellHasAPlaceOfItsOwn) {
  const Grid grid = test::grid_of(130, 65, 1.0, 1.0);
  const Regions regions(grid);
  EXPECT_EQ(regions.across, 3);
  EXPECT_EQ(regions.up, 2);
  EXPECT_EQ(regions.count(), 6U);
  std::set<std::pair<std::size_t, std::size_t>> places;
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      const std::size_t region = regions.of_cell(column, row), cell = cell_in_region(column, row);
      ASSERT_LT(region, regions.count());
      ASSERT_LT(cell, std::size_t{kRegionCells});
      EXPECT_TRUE(places.emplace(region, cell).second) << column << ' ' << row;
    }
  EXPECT_EQ(regions.of_cell(63, 63), 0U);
  EXPECT_EQ(regions.of_cell(64, 63), 1U);
  EXPECT_EQ(regions.of_cell(129, 64), 5U);
  EXPECT_EQ(cell_in_region(64 + 3, 2), 2U * 64U + 3U);
}

}  // namespace
}  // namespace talus
