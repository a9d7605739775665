#include "talus/terrain/no_height.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "talus/terrain/surface.hpp"

namespace talus {
namespace {

using Ring = std::vector<Eigen::Vector2d>;

/// 20 x 10 cells of 2 x 4 m, with a gap at column 10, row 5: no height from x = 19 to 23 and y = 18 to 26.
Raster<float> with_gap() {
  Raster<float> heights(Grid{20, 10, 2.0, 4.0, 0.0, 0.0}, 100.0F);
  heights.at(10, 5) = std::numeric_limits<float>::quiet_NaN();
  return heights;
}

double of_line(const Ring& line) {
  WithoutHeight sum;
  add_line(sum, with_gap(), line);
  return sum.share();
}

double of_polygon(const std::vector<Ring>& rings) {
  WithoutHeight sum;
  add_polygon(sum, with_gap(), rings);
  return sum.share();
}

Ring box(double west, double south, double east, double north) {
  return {{west, south}, {east, south}, {east, north}, {west, north}, {west, south}};
}

TEST(WithoutHeight, APlaceIsAsTheSurfaceSays) {
  const Raster<float> heights = with_gap();
  const Surface surface(heights);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> x(-5.0, 45.0), y(-5.0, 45.0);
  for (int i = 0; i < 5000; ++i) {
    const Eigen::Vector2d place(x(random), y(random));
    EXPECT_EQ(has_height(heights, place), surface.height(place.x(), place.y()).has_value()) << place.transpose();
  }
  EXPECT_FALSE(has_height(heights, {1e12, 20.0}));
  EXPECT_FALSE(has_height(heights, {std::numeric_limits<double>::quiet_NaN(), 20.0}));
}

TEST(WithoutHeight, LinesByTheirLength) {
  EXPECT_EQ(of_line({{5.0, 10.0}, {30.0, 10.0}, {30.0, 30.0}}), 0.0);
  EXPECT_EQ(of_line({{0.5, 0.0}, {0.5, 40.0}}), 1.0);              // in the outer half cell
  EXPECT_EQ(of_line({{-50.0, -3.0}, {80.0, -7.0}}), 1.0);          // off the DEM
  EXPECT_NEAR(of_line({{11.0, 22.0}, {31.0, 22.0}}), 0.2, 0.051);  // 4 of 20 m through the gap
  EXPECT_NEAR(of_line({{29.0, 10.0}, {49.0, 10.0}}), 0.5, 0.051);  // the last height at 39
  EXPECT_NEAR(of_line({{39.0, 20.0}, {1e8, 20.0}}), 1.0, 1e-3);
  EXPECT_EQ(of_line({{0.5, 0.5}, {0.5, 0.5}}), 0.0);  // no length
}

TEST(WithoutHeight, PolygonsByTheirArea) {
  EXPECT_EQ(of_polygon({box(5.0, 5.0, 15.0, 30.0)}), 0.0);
  EXPECT_EQ(of_polygon({box(20.0, 19.0, 22.0, 25.0)}), 1.0);                               // in the gap
  EXPECT_NEAR(of_polygon({box(15.0, 10.0, 27.0, 34.0)}), 32.0 / 288.0, 0.01);              // around it
  EXPECT_EQ(of_polygon({box(15.0, 10.0, 27.0, 34.0), box(18.0, 16.0, 24.0, 28.0)}), 0.0);  // with a hole there
  EXPECT_NEAR(of_polygon({box(29.0, 10.0, 229.0, 11.0)}), 0.95, 0.01);                     // the last height at 39
  EXPECT_NEAR(of_polygon({{{29.0, 5.0}, {49.0, 5.0}, {29.0, 25.0}}}), 0.25, 0.02);         // a triangle
  EXPECT_NEAR(of_polygon({{{5.0, 5.0}, {5.1, 5.0}, {45.1, 35.0}, {45.0, 35.0}}}), 6.0 / 40.0, 0.02);  // thin
  EXPECT_EQ(of_polygon({{}}), 0.0);
  EXPECT_EQ(of_polygon({}), 0.0);
}

}  // namespace
}  // namespace talus
