#include "talus/terrain/source_slope.hpp"

#include <gtest/gtest.h>

#include "support/scenes.hpp"

namespace talus {
namespace {

TEST(HornSlope, IsTheTangentOfAnyPlane) {
  for (const auto& [east, north] : {std::pair{0.0, 0.0}, {1.0, 0.0}, {0.0, -2.0}, {-0.75, 0.5}}) {
    const Raster<float> plane = test::terrain(test::grid_of(5, 4, 2.0, 4.0),
                                              [a = east, b = north](double x, double y) { return a * x + b * y; });
    for (int row = 1; row < 3; ++row)
      for (int column = 1; column < 4; ++column)
        EXPECT_DOUBLE_EQ(horn_slope(plane, column, row), std::hypot(east, north));
  }
}

TEST(HornSlope, WeighsTheNeighboursOneTwoOne) {  // by hand: one neighbour raised by 8 m in cells of 1 m
  for (const auto& [column, row, tangent] :
       {std::tuple{2, 1, 2.0}, {2, 2, std::sqrt(2.0)}, {1, 2, 2.0}, {0, 1, 2.0}, {1, 1, 0.0}}) {
    Raster<float> flat(test::grid_of(3, 3, 1.0, 1.0), 0.0F);
    flat.at(column, row) = 8.0F;
    EXPECT_DOUBLE_EQ(horn_slope(flat, 1, 1), tangent) << column << ' ' << row;
  }
}

TEST(HornSlope, IsNotKnownAtTheRimAndBesideMissingData) {
  for (int hole = 0; hole < 9; ++hole) {
    Raster<float> flat(test::grid_of(3, 3, 1.0, 1.0), 0.0F);
    EXPECT_EQ(horn_slope(flat, 1, 1), 0.0);
    EXPECT_EQ(std::isnan(horn_slope(flat, hole % 3, hole / 3)), hole != 4);
    flat.values[static_cast<std::size_t>(hole)] = std::nanf("");
    EXPECT_TRUE(std::isnan(horn_slope(flat, 1, 1))) << hole;
  }
}

TEST(TrueArea, IsTheAreaInPlanOverTheCosineOfHornsSlope) {  // by hand: tangents 2 and sqrt(2)
  for (const auto& [column, row, area] : {std::tuple{2, 1, std::sqrt(5.0)}, {2, 2, std::sqrt(3.0)}, {1, 1, 1.0}}) {
    Raster<float> flat(test::grid_of(3, 3, 1.0, 1.0), 0.0F);
    flat.at(column, row) = 8.0F;
    EXPECT_DOUBLE_EQ(true_area(flat, 1, 1), area) << column << ' ' << row;
  }
}

TEST(TrueArea, OfAPlaneIsThatOfThePlaneAtTheRimAndBesideAHole) {
  Raster<float> plane =
      test::terrain(test::grid_of(6, 5, 2.0, 4.0), [](double x, double y) { return 0.75 * x - 0.5 * y; });
  plane.at(2, 2) = std::nanf("");
  for (int row = 0; row < 5; ++row)
    for (int column = 0; column < 6; ++column) {
      if (column == 2 && row == 2) continue;
      EXPECT_DOUBLE_EQ(true_area(plane, column, row), 8.0 * std::sqrt(1.0 + 0.75 * 0.75 + 0.5 * 0.5));
    }
}

TEST(DefaultSourceSlope, IsTheTableOfTheManual) {  // docs/sources.md, one decimal
  for (const auto& [cell, angle] :
       {std::pair{0.5, 57.9}, {1.0, 55.0}, {2.0, 52.2}, {5.0, 48.7}, {10.0, 46.3}, {25.0, 43.2}})
    EXPECT_NEAR(degrees(default_source_slope(cell)), angle, 0.05) << cell;
}

}  // namespace
}  // namespace talus
