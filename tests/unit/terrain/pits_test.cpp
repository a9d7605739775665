#include "talus/terrain/pits.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/scenes.hpp"

namespace talus {
namespace {

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
