#include "talus/terrain/surface.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "support/scenes.hpp"

namespace talus {
namespace {

using test::Numbers;

constexpr float kMissing = std::numeric_limits<float>::quiet_NaN();

Raster<float> rough(int columns, int rows, double cell_x, double cell_y, std::uint64_t seed) {
  Numbers numbers(seed);
  return test::terrain(test::grid_of(columns, rows, cell_x, cell_y),
                       [&](double, double) { return numbers.uniform(900, 1000); });
}

TEST(Surface, IsTheDemAtTheCellCentres) {
  const Surface surface(rough(9, 6, 2.0, 5.0, 1));
  for (int row = 0; row < 5; ++row)
    for (int column = 0; column < 8; ++column) {
      const auto z = surface.height(2.0 * (column + 0.5), 5.0 * (row + 0.5));
      ASSERT_TRUE(z);
      EXPECT_EQ(*z, static_cast<double>(surface.heights().at(column, row)));
    }
}

TEST(Surface, EveryCornerOfAPatchIsItsCell) {
  const Surface surface(rough(4, 4, 1.0, 3.0, 2));
  Patch patch;
  ASSERT_TRUE(surface.read({1, 2}, patch));
  EXPECT_EQ(patch.height(0, 0), static_cast<double>(surface.heights().at(1, 2)));
  EXPECT_NEAR(patch.height(1, 0), surface.heights().at(2, 2), 1e-12);
  EXPECT_NEAR(patch.height(0, 1), surface.heights().at(1, 3), 1e-12);
  EXPECT_NEAR(patch.height(1, 1), surface.heights().at(2, 3), 1e-12);
}

TEST(Surface, EqualsBilinearWeightsEverywhere) {
  const Surface surface(rough(20, 30, 2.0, 0.5, 3));
  Numbers numbers(4);
  for (int i = 0; i < 100'000; ++i) {
    const double x = numbers.uniform(1.0, 39.0), y = numbers.uniform(0.25, 14.75);
    ASSERT_NEAR(*surface.height(x, y), test::height_between_centres(surface.heights(), x, y), 1e-10);
  }
}

TEST(Surface, IsAPlaneWhereTheDemIsOne) {
  const auto plane = [](double x, double y) { return 100.0 - 0.75 * x + 0.125 * y; };
  const Surface surface(test::terrain(test::grid_of(12, 12, 2.0, 4.0), plane));
  Numbers numbers(5);
  for (int i = 0; i < 1000; ++i) {
    const double x = numbers.uniform(1.0, 23.0), y = numbers.uniform(2.0, 46.0);
    EXPECT_NEAR(*surface.height(x, y), plane(x, y), 1e-12);
  }
  Patch patch;
  ASSERT_TRUE(surface.read({3, 4}, patch));
  EXPECT_NEAR(surface.gradient(patch, 0.3, 0.8).x(), -0.75, 1e-14);
  EXPECT_NEAR(surface.gradient(patch, 0.3, 0.8).y(), 0.125, 1e-14);
}

TEST(Surface, GradientIsTheFiniteDifferenceOfTheHeight) {
  const Surface surface(rough(10, 10, 2.0, 5.0, 6));
  Numbers numbers(7);
  const double h = 1e-3;  // the patch is linear along x and along y: central differences are exact but for rounding
  for (int i = 0; i < 10'000; ++i) {
    const PatchIndex at{static_cast<int>(numbers.uniform(0, 9)), static_cast<int>(numbers.uniform(0, 9))};
    const double p = numbers.uniform(0.01, 0.99), q = numbers.uniform(0.01, 0.99);
    const double x = surface.x_of(at.column + p), y = surface.y_of(at.row + q);
    Patch patch;
    ASSERT_TRUE(surface.read(at, patch));
    const Eigen::Vector2d gradient = surface.gradient(patch, p, q);
    ASSERT_NEAR(gradient.x(), (*surface.height(x + h, y) - *surface.height(x - h, y)) / (2 * h), 1e-8);
    ASSERT_NEAR(gradient.y(), (*surface.height(x, y + h) - *surface.height(x, y - h)) / (2 * h), 1e-8);
  }
}

TEST(Surface, IsContinuousAcrossTheEdgesOfPatches) {
  const Surface surface(rough(12, 12, 3.0, 2.0, 8));
  Numbers numbers(9);
  for (int i = 0; i < 10'000; ++i) {
    const int line = 1 + static_cast<int>(numbers.uniform(0, 10));
    const double share = numbers.uniform(0.0, 1.0);
    const int other = static_cast<int>(numbers.uniform(0, 11));
    Patch west, east, south, north;
    ASSERT_TRUE(surface.read({line - 1, other}, west) && surface.read({line, other}, east));
    ASSERT_NEAR(west.height(1.0, share), east.height(0.0, share), 1e-11);
    ASSERT_TRUE(surface.read({other, line - 1}, south) && surface.read({other, line}, north));
    ASSERT_NEAR(south.height(share, 1.0), north.height(share, 0.0), 1e-11);
  }
}

TEST(Surface, PlacesAndPatchCoordinatesAreInverse) {
  const Surface surface(rough(12, 12, 3.0, 2.0, 10));
  for (const double x : {1.5, 1.6, 20.0, 34.0}) EXPECT_NEAR(surface.x_of(surface.u_of(x)), x, 1e-13);
  for (const double y : {1.0, 1.6, 20.0, 22.9}) EXPECT_NEAR(surface.y_of(surface.v_of(y)), y, 1e-13);
  EXPECT_EQ(surface.u_of(1.5), 0.0);  // the first centre
  EXPECT_EQ(surface.patch_at(4.6, 2.9), (PatchIndex{1, 0}));
}

TEST(Surface, OutsideTheCentresThereIsNone) {
  const Surface surface(rough(5, 4, 2.0, 3.0, 11));  // centres from (1, 1.5) to (9, 10.5)
  for (const auto& [x, y] :
       {std::pair{0.99, 5.0}, {9.01, 5.0}, {5.0, 1.49}, {5.0, 10.51}, {-50.0, 5.0}, {5.0, 1e6}, {-0.5, -0.5}})
    EXPECT_FALSE(surface.height(x, y)) << x << ' ' << y;
  EXPECT_TRUE(surface.height(1.0, 1.5));
  EXPECT_TRUE(surface.height(8.99, 10.49));
  Patch patch;
  for (const PatchIndex i : {PatchIndex{-1, 0}, {0, -1}, {4, 0}, {0, 3}}) EXPECT_FALSE(surface.read(i, patch));
  EXPECT_TRUE(surface.read({3, 2}, patch));
}

TEST(Surface, AMissingCornerTakesItsFourPatchesAndNoOther) {
  Raster<float> heights = rough(6, 6, 1.0, 1.0, 12);
  heights.at(2, 3) = kMissing;
  const Surface surface(heights);
  Patch patch;
  for (int row = 0; row < 5; ++row)
    for (int column = 0; column < 5; ++column) {
      const bool touched = (column == 1 || column == 2) && (row == 2 || row == 3);
      EXPECT_EQ(surface.read({column, row}, patch), !touched) << column << ' ' << row;
    }
  EXPECT_FALSE(surface.height(2.2, 3.2));
}

TEST(Surface, OneRowOrColumnHasNoPatch) {
  Patch patch;
  EXPECT_FALSE(Surface(rough(1, 5, 1.0, 1.0, 13)).read({0, 0}, patch));
  EXPECT_FALSE(Surface(rough(5, 1, 1.0, 1.0, 14)).read({0, 0}, patch));
}

TEST(NormalOf, IsUnitUpwardsAndAcrossBothTangents) {
  Numbers numbers(15);
  for (int i = 0; i < 10'000; ++i) {
    const Eigen::Vector2d slope(numbers.uniform(-20, 20), numbers.uniform(-20, 20));
    const Vec3 n = normal_of(slope);
    ASSERT_NEAR(n.norm(), 1.0, 4 * test::kEps);
    ASSERT_GT(n.z(), 0.0);
    ASSERT_NEAR(n.dot(Vec3(1, 0, slope.x())), 0.0, 1e-14);
    ASSERT_NEAR(n.dot(Vec3(0, 1, slope.y())), 0.0, 1e-14);
  }
}

}  // namespace
}  // namespace talus
