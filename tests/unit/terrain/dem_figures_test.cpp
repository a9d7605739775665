#include "talus/terrain/dem_figures.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "talus/base/vector.hpp"

namespace talus {
namespace {

Raster<float> raster(double (*height)(double x, double y), int columns = 40, int rows = 30, double cell = 2.0) {
  Raster<float> heights(Grid{columns, rows, cell, cell, 0.0, 0.0}, 0.0F);
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column)
      heights.at(column, row) = static_cast<float>(height(column * cell, row * cell));
  return heights;
}

TEST(DemFigures, OfAPlaneAreItsSlope) {  // heights of 0.6 x 2 m: multiples of 0.2, and straight
  const DemFigures plane = dem_figures(raster([](double x, double) { return 0.6 * x; }));
  EXPECT_EQ(plane.cells, 38U * 28U);
  EXPECT_NEAR(plane.median_slope, std::atan(0.6), 1e-6);
  EXPECT_EQ(plane.steep_share, 0.0);
  EXPECT_EQ(plane.flat_share, 0.0);
  EXPECT_EQ(plane.step, 0.2);
  const DemFigures level = dem_figures(raster([](double, double) { return 1000.0; }));
  EXPECT_EQ(level.flat_share, 1.0);
  EXPECT_EQ(level.bend_share, 0.0);
}

TEST(DemFigures, StepsAreFoundAndBendRows) {
  const auto rough = [](double x, double y) { return 700.0 + 0.7 * y + 3.0 * std::sin(x / 3.1) + std::sin(y / 2.3); };
  EXPECT_EQ(dem_figures(raster(rough)).step, 0.0);
  const DemFigures metres = dem_figures(raster(
      [](double x, double y) { return std::round(700.0 + 0.7 * y + 3.0 * std::sin(x / 3.1) + std::sin(y / 2.3)); }));
  EXPECT_EQ(metres.step, 1.0);
  EXPECT_GT(metres.bend_share, 0.2);
  const DemFigures feet = dem_figures(
      raster([](double x, double y) { return 0.3048 * std::round(2300.0 + 2.0 * y + 9.0 * std::sin(x / 3.1)); }));
  EXPECT_EQ(feet.step, 0.3048);
}

TEST(DemFigures, SteepCellsAndGapsAreCounted) {
  const double tan_81 = std::tan(radians(81.0));
  Raster<float> wall(Grid{22, 12, 1.0, 1.0, 0.0, 0.0}, 0.0F);
  for (int row = 0; row < 12; ++row)
    for (int column = 0; column < 22; ++column)
      wall.at(column, row) = static_cast<float>(tan_81 * std::max(0, column - 10));
  const DemFigures figures = dem_figures(wall);  // interior columns 1 to 20: 11 to 20 are steep, 1 to 9 flat
  EXPECT_DOUBLE_EQ(figures.steep_share, 10.0 / 20.0);
  EXPECT_DOUBLE_EQ(figures.flat_share, 9.0 / 20.0);
  for (float& height : wall.values) height *= static_cast<float>(std::tan(radians(79.5)) / tan_81);
  EXPECT_EQ(dem_figures(wall).steep_share, 0.0);
  wall.at(20, 5) = std::numeric_limits<float>::quiet_NaN();  // takes away columns 19 and 20 of rows 4 to 6
  EXPECT_EQ(dem_figures(wall).cells, 20U * 10U - 6U);
}

}  // namespace
}  // namespace talus
