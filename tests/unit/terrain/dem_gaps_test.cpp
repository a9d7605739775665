#include "talus/terrain/dem_gaps.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace talus {
namespace {

constexpr float kNoHeight = std::numeric_limits<float>::quiet_NaN();

/// A level DEM from a drawing, the northern row first: '#' has no height.
Raster<float> drawn(const std::vector<std::string>& rows) {
  Grid grid{static_cast<int>(rows[0].size()), static_cast<int>(rows.size()), 2.0, 2.0, 0.0, 0.0};
  Raster<float> heights(grid, 100.0F);
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column)
      if (rows[static_cast<std::size_t>(grid.rows - 1 - row)][static_cast<std::size_t>(column)] == '#')
        heights.at(column, row) = kNoHeight;
  return heights;
}

/// The cells beside gaps as a drawing: 'x' is beside one, '.' is not.
std::vector<std::string> beside(const Raster<float>& heights) {
  DemGaps gaps(heights);
  const Grid& grid = heights.grid;
  std::vector<std::string> rows;
  for (int row = grid.rows - 1; row >= 0; --row) {
    rows.emplace_back();
    for (int column = 0; column < grid.columns; ++column) rows.back() += gaps.beside(column, row) ? 'x' : '.';
  }
  return rows;
}

using Drawing = std::vector<std::string>;

TEST(DemGaps, AHoleIsAGap) {
  EXPECT_EQ(beside(drawn({"........", "........", "...##...", "........", "........", "........"})),
            (Drawing{"........", "..xxxx..", "..xxxx..", "..xxxx..", "........", "........"}));
}

TEST(DemGaps, ACompleteDemHasNone) {
  EXPECT_EQ(beside(drawn({"....", "....", "...."})), (Drawing{"....", "....", "...."}));
}

TEST(DemGaps, ABayThatIsOpenToTheEdgeIsNone) {
  EXPECT_EQ(beside(drawn({"........", "........", "..####..", "..#..#..", ".....#..", ".....#.."})),
            Drawing(6, "........"));
}

TEST(DemGaps, CellsThatTouchAtACornerAreConnected) {
  EXPECT_EQ(beside(drawn({"......#", ".....#.", "....#..", "...#...", "......."})), Drawing(5, "......."));
  EXPECT_EQ(beside(drawn({".......", ".....#.", "....#..", "...#...", "......."})),
            (Drawing{".......", "...xxx.", "..xxxx.", "..xxxx.", "......."}));
}

TEST(DemGaps, OfBothBesideACellTheEdgeCounts) {  // column 3 is between the outline and a gap
  EXPECT_EQ(beside(drawn({"###.......", "###.......", "###.##....", "###.......", "###......."})),
            (Drawing{"..........", "....xxx...", "....xxx...", "....xxx...", ".........."}));
}

TEST(DemGaps, AnIslandInAGapIsBesideIt) {
  EXPECT_EQ(beside(drawn({".......", ".......", "..###..", "..#.#..", "..###..", ".......", "......."})),
            (Drawing{".......", ".xxxxx.", ".xxxxx.", ".xxxxx.", ".xxxxx.", ".xxxxx.", "......."}));
}

/// The cells without a height that are in no gap, by spreading from the outer rows and columns until nothing changes.
std::vector<bool> outside_by_spreading(const Raster<float>& heights) {
  const Grid& grid = heights.grid;
  std::vector<bool> outside(grid.cells());
  for (bool changed = true; changed;) {
    changed = false;
    for (int row = 0; row < grid.rows; ++row)
      for (int column = 0; column < grid.columns; ++column) {
        if (!std::isnan(heights.at(column, row)) || outside[grid.index(column, row)]) continue;
        bool reached = false;
        for (int r = row - 1; r <= row + 1; ++r)
          for (int c = column - 1; c <= column + 1; ++c)
            reached = reached || !grid.contains(c, r) || outside[grid.index(c, r)];
        if (reached) changed = outside[grid.index(column, row)] = true;
      }
  }
  return outside;
}

TEST(DemGaps, AreThoseOfSpreadingFromTheEdgeInAnyOrderOfTheCells) {
  std::mt19937 random(5);
  for (const double share : {0.1, 0.3, 0.4, 0.5}) {
    Raster<float> heights(Grid{41, 37, 1.0, 1.0, 0.0, 0.0}, 100.0F);
    for (float& z : heights.values)
      if (static_cast<double>(random() % 1000) < 1000 * share) z = kNoHeight;
    const std::vector<bool> outside = outside_by_spreading(heights);
    const Grid& grid = heights.grid;
    std::vector<std::size_t> order(grid.cells());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::ranges::shuffle(order, random);
    DemGaps gaps(heights);
    for (const std::size_t cell : order) {
      const int column = static_cast<int>(cell) % grid.columns, row = static_cast<int>(cell) / grid.columns;
      bool gap = false, edge = false;
      for (int r = row - 1; r <= row + 1; ++r)
        for (int c = column - 1; c <= column + 1; ++c) {
          edge = edge || !grid.contains(c, r) || outside[grid.index(c, r)];
          gap = gap || (grid.contains(c, r) && std::isnan(heights.at(c, r)));
        }
      ASSERT_EQ(gaps.beside(column, row), gap && !edge) << share << ' ' << column << ' ' << row;
    }
  }
}

}  // namespace
}  // namespace talus
