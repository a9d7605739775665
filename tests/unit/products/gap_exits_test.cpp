#include "talus/products/gap_exits.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "support/scenes.hpp"

namespace talus {
namespace {

StopRow end_at(double x, double y, End end) {
  StopRow row{};
  row.x = x, row.y = y, row.end = end;
  return row;
}

/// 20 x 20 cells of 5 m with a hole of columns 8 to 11 and rows 8 to 9, that is x from 40 to 60 m, y from 40 to 50 m.
Raster<float> with_hole() {
  Raster<float> heights(test::grid_of(20, 20, 5.0, 5.0), 100.0F);
  for (int row = 8; row <= 9; ++row)
    for (int column = 8; column <= 11; ++column) heights.at(column, row) = std::numeric_limits<float>::quiet_NaN();
  return heights;
}

TEST(GapExits, AreBlocksThatLeaveAtTheHole) {
  const Raster<float> heights = with_hole();
  GapExits exits(heights);
  exits.add({});
  EXPECT_EQ(exits.blocks(), 0U);
  for (const End end : {End::Stopped, End::Trapped, End::Left, End::Caught, End::Limit})
    exits.add(std::vector{end_at(51.0, 52.5, end)});  // the row of centres north of the hole
  exits.add(std::vector{end_at(37.5, 44.0, End::Left), end_at(62.5, 37.5, End::Left)});  // west of it, at its corner
  exits.add(std::vector{end_at(51.0, 2.5, End::Left), end_at(97.5, 45.0, End::Left)});   // at the edge of the DEM
  exits.add(std::vector{end_at(-1.0, 45.0, End::Left)});                                 // released off the DEM
  EXPECT_EQ(exits.blocks(), 3U);
}

}  // namespace
}  // namespace talus
