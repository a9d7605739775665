#include "talus/terrain/grid.hpp"

#include <gtest/gtest.h>

#include <set>

#include "support/scenes.hpp"
#include "talus/terrain/raster.hpp"

namespace talus {
namespace {

const Grid kGrid = test::grid_of(7, 4, 2.5, 0.5);  // cells that are not square

TEST(Grid, SizeInMetres) {
  EXPECT_EQ(kGrid.width(), 17.5);
  EXPECT_EQ(kGrid.height(), 2.0);
  EXPECT_EQ(kGrid.cells(), 28U);
}

TEST(Grid, ACentreIsInItsOwnCellAndSoAreItsNeighbourhoods) {
  for (int column = 0; column < 7; ++column)
    for (int row = 0; row < 4; ++row)
      for (const double share : {-0.499, 0.0, 0.499}) {
        EXPECT_EQ(kGrid.column_of(kGrid.centre_x(column) + share * 2.5), column);
        EXPECT_EQ(kGrid.row_of(kGrid.centre_y(row) + share * 0.5), row);
      }
}

TEST(Grid, BordersAndOutside) {
  EXPECT_EQ(kGrid.column_of(0.0), 0);  // a cell has its western and southern border
  EXPECT_EQ(kGrid.column_of(2.5), 1);
  EXPECT_EQ(kGrid.row_of(0.5), 1);
  EXPECT_EQ(kGrid.column_of(-1e-12), -1);  // not 0, as a plain cast would give
  EXPECT_EQ(kGrid.row_of(-0.1), -1);
  EXPECT_TRUE(kGrid.contains(0, 0) && kGrid.contains(6, 3));
  EXPECT_FALSE(kGrid.contains(-1, 0) || kGrid.contains(0, -1) || kGrid.contains(7, 0) || kGrid.contains(0, 4));
}

TEST(Grid, IndexIsOneToOneRowByRowFromTheSouth) {
  std::set<std::size_t> seen;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 7; ++column) seen.insert(kGrid.index(column, row));
  EXPECT_EQ(seen.size(), 28U);
  EXPECT_EQ(*seen.rbegin(), 27U);
  EXPECT_EQ(kGrid.index(0, 0), 0U);
  EXPECT_EQ(kGrid.index(1, 0), 1U);
  EXPECT_EQ(kGrid.index(0, 1), 7U);
}

TEST(Grid, IndexDoesNotOverflowInt) {
  const Grid large = test::grid_of(60'000, 60'000, 1.0, 1.0);
  EXPECT_EQ(large.index(59'999, 59'999), 3'599'999'999U);
  EXPECT_EQ(large.cells(), 3'600'000'000U);
}

TEST(Raster, AtReadsWhatWasWritten) {
  Raster<int> raster(kGrid, 5);
  raster.at(6, 3) = 1;
  raster.at(0, 2) = 2;
  EXPECT_EQ(raster.values[raster.values.size() - 1], 1);
  EXPECT_EQ(raster.values[14], 2);
  EXPECT_EQ(raster.at(3, 1), 5);
}

}  // namespace
}  // namespace talus
