#include "talus/terrain/steep_gully.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/scenes.hpp"
#include "talus/base/vector.hpp"

namespace talus {
namespace {

const double kTanPhi = std::tan(radians(30.0));
constexpr double kCell = 5.0;
constexpr int kCells = 60;

/// A V gully with walls of 45 degrees through the centre of cell (10, 10), at an angle to the grid.
struct Gully {
  double floor, angle;  // slope of the thalweg, its direction [rad]

  Raster<float> heights() const {
    return test::terrain(test::grid_of(kCells, kCells, kCell, kCell), [&](double x, double y) {
      const double dx = x - 10.5 * kCell, dy = y - 10.5 * kCell;
      const double along = dx * std::cos(angle) + dy * std::sin(angle),
                   across = dy * std::cos(angle) - dx * std::sin(angle);
      return 500.0 - std::tan(floor) * along + std::abs(across);
    });
  }
  /// Share of the cells along 200 m of the thalweg that belong to a steep gully.
  double found() const {
    const Raster<float> z = heights();
    int count = 0;
    for (int metre = 0; metre < 200; ++metre) {
      const double x = 10.5 * kCell + metre * std::cos(angle), y = 10.5 * kCell + metre * std::sin(angle);
      count += in_steep_gully(z, z.grid.column_of(x), z.grid.row_of(y), kTanPhi) ? 1 : 0;
    }
    return count / 200.0;
  }
};

TEST(SteepGully, IsFoundAlongAThalwegSteeperThanPhi) {  // at angles of docs/physics.md, "Creases"
  for (const double angle : {0.0, 20.0, 30.0, 45.0})
    EXPECT_EQ((Gully{radians(35.0), radians(angle)}.found()), 1.0) << angle;
}

TEST(SteepGully, IsNoneWhereTheFloorIsLessSteepThanPhi) {  // walls hold a block there in the real gully, too
  for (const double floor : {0.0, 20.0})
    for (const double angle : {0.0, 45.0}) EXPECT_EQ((Gully{radians(floor), radians(angle)}.found()), 0.0);
}

int count(const Raster<float>& heights) {
  int found = 0;
  for (int row = -1; row <= heights.grid.rows; ++row)
    for (int column = -1; column <= heights.grid.columns; ++column)
      found += in_steep_gully(heights, column, row, kTanPhi) ? 1 : 0;
  return found;
}

TEST(SteepGully, IsNoPlaneNoRidgeAndNoRoadCutIntoASlope) {
  const Grid grid = test::grid_of(30, 30, kCell, kCell);
  for (const auto& [east, north] : {std::pair{0.7, 0.0}, {0.5, -1.0}, {2.0, 2.0}})
    EXPECT_EQ(count(test::terrain(grid, [a = east, b = north](double x, double y) { return a * x + b * y; })), 0);
  EXPECT_EQ(count(test::terrain(grid, [](double x, double y) { return 0.7 * x - std::abs(y - 77.5); })), 0);
  EXPECT_EQ(count(test::terrain(grid,
                                [](double, double y) {  // 40 degrees, with a level road 10 m wide
                                  return 0.84 * (y < 70.0 ? y : std::max(70.0, y - 10.0));
                                })),
            0);
}

TEST(SteepGully, IsNotKnownAtTheRimAndBesideMissingHeights) {
  Raster<float> z = Gully{radians(35.0), 0.0}.heights();
  EXPECT_FALSE(in_steep_gully(z, 0, 10, kTanPhi));
  EXPECT_TRUE(in_steep_gully(z, 1, 10, kTanPhi));
  z.at(3, 11) = std::numeric_limits<float>::quiet_NaN();
  for (int column = 2; column <= 4; ++column) EXPECT_FALSE(in_steep_gully(z, column, 10, kTanPhi));
  EXPECT_TRUE(in_steep_gully(z, 6, 10, kTanPhi));
}

}  // namespace
}  // namespace talus
