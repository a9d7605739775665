#include "talus/terrain/pits.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/scenes.hpp"

namespace talus {
namespace {

Raster<float> square(const std::vector<float>& values) {  // 3 x 3, from the south-western cell
  Raster<float> heights(Grid{3, 3, 1.0, 1.0, 0.0, 0.0}, 0.0F);
  for (int i = 0; i < 9; ++i) heights.at(i % 3, i / 3) = values[static_cast<std::size_t>(i)];
  return heights;
}

TEST(Dammed, IsACellWhoseOnlyWayDownIsDiagonal) {
  EXPECT_TRUE(dammed(square({9, 6, 4, 6, 5, 6, 9, 6, 9}), 1, 1));
  EXPECT_TRUE(dammed(square({9, 6, 9, 6, 5, 6, 4, 6, 9}), 1, 1));
  EXPECT_FALSE(dammed(square({9, 6, 5, 6, 5, 6, 9, 6, 9}), 1, 1));  // level
  EXPECT_FALSE(dammed(square({9, 6, 9, 6, 5, 6, 9, 6, 9}), 1, 1));  // a pit
  EXPECT_FALSE(dammed(square({9, 5, 4, 6, 5, 6, 9, 6, 9}), 1, 1));  // a level way to a side
  EXPECT_FALSE(dammed(square({9, 6, 4, 6, 5, 6, 9, 6, 9}), 0, 1));  // at the edge
  const float missing = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(dammed(square({9, missing, 4, 6, 5, 6, 9, 6, 9}), 1, 1));
}

TEST(Dammed, HasTheHeightOfItsLowestSide) {
  EXPECT_EQ(dam_height(square({9, 6, 4, 8, 5, 7, 9, 6.5F, 9}), 1, 1), 1.0);
  EXPECT_EQ(dam_height(square({9, 7, 4, 8, 5, 5.25F, 9, 6, 9}), 1, 1), 0.25);
  EXPECT_EQ(dam_height(square({9, 6, 9, 6, 5, 6, 9, 6, 9}), 1, 1), 0.0);  // a pit
}

TEST(Dammed, AreCountedAmongCellsWithAHeight) {
  const float missing = std::numeric_limits<float>::quiet_NaN();
  const DamCount count = count_dammed(square({missing, 6, 4, 6, 5, 6, 9, 6, 9}));
  EXPECT_EQ(count.dammed, 1U);
  EXPECT_EQ(count.cells, 8U);
  EXPECT_EQ(count.share(), 0.125);
}

TEST(Dammed, AreCountedWhereTheyAreAskedFor) {
  const Raster<float> heights = square({9, 6, 4, 6, 5, 6, 9, 6, 9});
  EXPECT_EQ(count_dammed(heights, [](int column, int row) { return column == 1 && row == 1; }).dammed, 1U);
  EXPECT_EQ(count_dammed(heights, [](int column, int) { return column != 1; }).dammed, 0U);
  EXPECT_EQ(count_dammed(heights, [](int, int) { return false; }).cells, 9U);
}

Raster<float> flat() {
  return Raster<float>(test::grid_of(7, 6, 2.0, 2.0), 10.0F);
}

TEST(Pits, ACellLowerThanAllEightByItsDepth) {
  Raster<float> heights = flat();
  heights.at(3, 2) = 9.25F;
  heights.at(4, 3) = 9.75F;  // the lowest neighbour, across a corner: higher than the pit, lower than its others
  EXPECT_EQ(pit_depth(heights, 3, 2), 0.5);
  EXPECT_EQ(pit_depth(heights, 4, 3), 0.0);
  const PitSummary pits = summary_of_pits(heights);
  EXPECT_EQ(pits.count, 1U);
  EXPECT_EQ(pits.deepest, 0.5);
}

TEST(Pits, ALowerDiagonalNeighbourIsAWayOut) {  // a dam between two cells of a diagonal gully is no true pit
  Raster<float> heights = flat();
  heights.at(3, 2) = 9.0F;
  heights.at(4, 3) = 8.0F;
  EXPECT_EQ(pit_depth(heights, 3, 2), 0.0);
  EXPECT_EQ(pit_depth(heights, 4, 3), 1.0);
  heights.at(4, 3) = 9.0F;  // level with it: neither is lower than all
  EXPECT_EQ(summary_of_pits(heights).count, 0U);
}

TEST(Pits, NoneAtTheRimOrBesideMissingData) {  // a block could leave there
  Raster<float> heights = flat();
  heights.at(0, 2) = heights.at(3, 0) = heights.at(6, 5) = 0.0F;
  EXPECT_EQ(summary_of_pits(heights).count, 0U);
  heights.at(3, 3) = 0.0F;
  EXPECT_EQ(summary_of_pits(heights).count, 1U);
  heights.at(4, 4) = std::nanf("");
  EXPECT_EQ(summary_of_pits(heights).count, 0U);
  EXPECT_EQ(summary_of_pits(Raster<float>(test::grid_of(1, 1, 2.0, 2.0), 1.0F)).count, 0U);
}

}  // namespace
}  // namespace talus
