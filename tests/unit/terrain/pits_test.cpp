#include "talus/terrain/pits.hpp"

#include <gtest/gtest.h>

#include <limits>

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

TEST(Dammed, AreCountedAmongCellsWithAHeight) {
  const float missing = std::numeric_limits<float>::quiet_NaN();
  const DamCount count = count_dammed(square({missing, 6, 4, 6, 5, 6, 9, 6, 9}));
  EXPECT_EQ(count.dammed, 1U);
  EXPECT_EQ(count.cells, 8U);
  EXPECT_EQ(count.share(), 0.125);
}

}  // namespace
}  // namespace talus
