#include "talus/terrain/surface.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "support/scenes.hpp"
#include "talus/terrain/pits.hpp"

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
  const Surface surface(rough(20, 30, 2.0, 0.5, 3), SurfaceKind::Bilinear);
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
  const Surface surface(rough(10, 10, 2.0, 5.0, 6), SurfaceKind::Bilinear);
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

Crease crease_at(const Surface& surface, int column, int row) {
  Patch patch;
  EXPECT_TRUE(surface.read({column, row}, patch));
  return surface.crease(patch);
}

TEST(CreasedSurface, IsTwoTrianglesWhereABilinearPatchIsADamAndThePatchElsewhere) {
  const Surface bilinear(rough(40, 30, 2.0, 0.5, 31)), surface(bilinear.heights(), SurfaceKind::Creased);
  Numbers numbers(32);
  int creased = 0, rising = 0;
  for (int i = 0; i < 100'000; ++i) {
    const double x = numbers.uniform(1.0, 79.0), y = numbers.uniform(0.25, 14.75);
    ASSERT_NEAR(*surface.height(x, y), test::height_on_creases(surface.heights(), x, y), 1e-10);
    const PatchIndex at = surface.patch_at(x, y);
    const Crease crease = crease_at(surface, at.column, at.row);
    creased += crease != Crease::None ? 1 : 0;
    rising += crease == Crease::Rising ? 1 : 0;
    if (crease == Crease::None) {
      ASSERT_EQ(*surface.height(x, y), *bilinear.height(x, y)) << x << ' ' << y;
    }
  }
  EXPECT_GT(rising, creased / 3);
  EXPECT_LT(rising, creased - creased / 3);
}

TEST(CreasedSurface, HasNoGapAtEdgesAndDiagonals) {
  const Surface surface(rough(30, 30, 2.0, 2.0, 33), SurfaceKind::Creased);  // no slope above 71
  Numbers numbers(34);
  constexpr double kStep = 1e-7;
  for (int i = 0; i < 100'000; ++i) {
    const double along = numbers.uniform(0.0, 1.0);
    const int column = static_cast<int>(numbers.uniform(1, 27)), row = static_cast<int>(numbers.uniform(1, 27));
    const double places[4][2]{{0.0, along}, {along, 0.0}, {along, along}, {along, 1.0 - along}};
    for (const auto& [p, q] : places) {
      const double x = surface.x_of(column + p), y = surface.y_of(row + q);
      for (const auto& [dx, dy] : {std::pair{kStep, 0.0}, {0.0, kStep}, {kStep, kStep}, {kStep, -kStep}})
        ASSERT_NEAR(*surface.height(x + dx, y + dy), *surface.height(x - dx, y - dy), 300.0 * kStep);
    }
  }
}

TEST(CreasedSurface, TurnsAndMirrorsWithTheTerrain) {
  const Raster<float> heights = rough(24, 24, 3.0, 3.0, 35);
  const Surface surface(heights, SurfaceKind::Creased);
  const auto placed = [&](bool swapped, bool west, bool south) {  // the eight orientations of a square
    Raster<float> out = heights;
    for (int row = 0; row < 24; ++row)
      for (int column = 0; column < 24; ++column) {
        const int c = west ? 23 - column : column, r = south ? 23 - row : row;
        out.at(swapped ? r : c, swapped ? c : r) = heights.at(column, row);
      }
    return Surface(std::move(out), SurfaceKind::Creased);
  };
  Numbers numbers(36);
  for (const bool swapped : {false, true})
    for (const bool west : {false, true})
      for (const bool south : {false, true}) {
        const Surface other = placed(swapped, west, south);
        for (int i = 0; i < 2000; ++i) {
          const double x = numbers.uniform(1.5, 70.5), y = numbers.uniform(1.5, 70.5);
          const double a = west ? 72.0 - x : x, b = south ? 72.0 - y : y;
          ASSERT_NEAR(*other.height(swapped ? b : a, swapped ? a : b), *surface.height(x, y), 1e-9);
        }
      }
}

TEST(CreasedSurface, HasNoCreaseOnAPlaneAndOnACone) {
  for (const double azimuth : {0.0, 0.3, 0.785398163397448, 1.1, 2.5, 4.0}) {
    const auto plane = [&](double x, double y) {
      return 1500.0 - 0.8 * (x * std::cos(azimuth) + y * std::sin(azimuth));
    };
    const auto cone = [&](double x, double y) { return 900.0 - 0.7 * std::hypot(x - 61.3 - azimuth, y - 59.9); };
    for (const Surface& surface : {Surface(test::terrain(test::grid_of(60, 60, 2.0, 2.0), plane), SurfaceKind::Creased),
                                   Surface(test::terrain(test::grid_of(60, 60, 2.0, 2.0), cone), SurfaceKind::Creased)})
      for (int row = 0; row < 59; ++row)
        for (int column = 0; column < 59; ++column)
          ASSERT_EQ(crease_at(surface, column, row), Crease::None) << azimuth << ' ' << column << ' ' << row;
  }
}

TEST(CreasedSurface, FallsFromEveryCellThatHasALowerDiagonalNeighbour) {
  const Surface bilinear(rough(60, 60, 1.0, 1.0, 37), SurfaceKind::Bilinear),
      creased(bilinear.heights(), SurfaceKind::Creased);
  int dams = 0;
  for (int row = 1; row < 59; ++row)
    for (int column = 1; column < 59; ++column) {
      if (!dammed(bilinear.heights(), column, row)) continue;
      ++dams;
      const auto lowest_around = [&](const Surface& surface) {  // on a small square
        double lowest = 1e9;
        for (const double dx : {-1e-3, 0.0, 1e-3})
          for (const double dy : {-1e-3, 0.0, 1e-3})
            if (dx != 0.0 || dy != 0.0) lowest = std::min(lowest, *surface.height(column + 0.5 + dx, row + 0.5 + dy));
        return lowest;
      };
      EXPECT_GT(lowest_around(bilinear), bilinear.heights().at(column, row));
      EXPECT_LT(lowest_around(creased), bilinear.heights().at(column, row));
    }
  EXPECT_GT(dams, 200);
}

TEST(CreasedSurface, MeetsABlockOnTheHalfThatItMovesInto) {
  // A gully from the south-western corner down to the north-eastern one; the wall in the south-east is the steeper one.
  const Raster<float> heights(Grid{2, 2, 2.0, 2.0, 0.0, 0.0}, {10.0F, 14.0F, 12.0F, 8.0F});
  const Surface surface(heights, SurfaceKind::Creased);
  Patch patch;
  ASSERT_TRUE(surface.read({0, 0}, patch));
  ASSERT_EQ(surface.crease(patch), Crease::Rising);
  const auto gradient = [&](double p, double q, double vx, double vy) {
    return surface.gradient(surface.facet(patch, p, q, {vx, vy, -1.0}), p, q);
  };
  const Eigen::Vector2d south_east(2.0, -3.0), north_west(-2.0, 1.0);  // of the planes through three corners
  EXPECT_EQ(gradient(0.7, 0.2, -5.0, 5.0), south_east);
  EXPECT_EQ(gradient(0.2, 0.7, 5.0, -5.0), north_west);
  EXPECT_EQ(gradient(0.5, 0.5, 3.0, 2.9), south_east);
  EXPECT_EQ(gradient(0.5, 0.5, 2.9, 3.0), north_west);
  EXPECT_EQ(gradient(0.5, 0.5, 3.0, 3.0), Eigen::Vector2d(0.0, -1.0));  // along the crease: between the halves
}

TEST(SurfaceNames, ReadBack) {
  EXPECT_EQ(surface_kind("bilinear"), SurfaceKind::Bilinear);
  EXPECT_EQ(surface_kind("creased"), SurfaceKind::Creased);
  EXPECT_EQ(surface_kind("smooth"), std::nullopt);
  for (const auto name : kSurfaceNames) EXPECT_EQ(name_of(*surface_kind(name)), name);
}

}  // namespace
}  // namespace talus
