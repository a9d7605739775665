#include "talus/physics/effects/forest_stems.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "support/slopes.hpp"

namespace talus {
namespace {

using test::block_at;
using test::Hillside;
using test::Moments;
using test::same_bits;

TEST(ForestStems, CapacityShareAndRateOfTheLiterature) {
  const double table[][2] = {{20, 39e3}, {30, 100e3}, {40, 194e3}, {50, 325e3}, {60, 496e3}};  // Dorren & Berger
  for (const auto& [dbh, energy] : table) EXPECT_NEAR(stem_capacity(dbh / 100.0, 1.0), energy, 0.005 * energy) << dbh;
  EXPECT_NEAR(stem_capacity(0.3, 1.6), 1.6 * 99.9e3, 500.0);
  EXPECT_NEAR(stem_share(0.0), 0.98, 1e-3);
  EXPECT_NEAR(stem_share(0.58), -0.046 + 1.026 / 2.0, 1e-12);
  EXPECT_EQ(stem_share(1.0), 0.0);
  for (double e = -1.0; e < 0.0; e += 0.01) {
    EXPECT_EQ(stem_share(e), stem_share(-e));
    EXPECT_LE(stem_share(e), stem_share(e + 0.01));
  }
  EXPECT_NEAR(mean_free_path({.density = 400.0, .diameter = 0.35}, 1.0), 18.5, 0.05);
}

TEST(ForestStems, TheSpeedLosesTheEnergyAndTheWayTurnsAway) {
  const Vec3 v(12.0, 9.0, -5.0);
  for (double e = -0.95; e < 1.0; e += 0.1)
    for (const double share : {0.0, 0.1, 0.5, 0.9}) {
      const double taken = 0.5 * share * v.squaredNorm();
      const Vec3 after = velocity_after_stem(v, taken, e);
      EXPECT_NEAR(after.squaredNorm(), v.squaredNorm() - 2.0 * taken, 1e-10);
      EXPECT_NEAR(after.z() / v.z(), std::sqrt(1.0 - share), 1e-12);
      const double left = v.x() * after.y() - v.y() * after.x();  // > 0: turned to the left
      if (share > 0.0) {
        EXPECT_LT(left * e, 0.0) << e << ' ' << share;  // the axis on the left turns it to the right
      }
      EXPECT_GE(v.head<2>().dot(after.head<2>()), 0.0);  // never back
    }
  EXPECT_EQ(velocity_after_stem(v, 0.5 * v.squaredNorm(), 0.0), Vec3(Vec3::Zero()));
  // The impulse goes through the axis: what lies across it does not change. 30 degrees off, a tenth of the energy:
  const Vec3 after = velocity_after_stem({10.0, 0.0, 0.0}, 5.0, 0.5);
  const Vec3 across(0.5, -std::sqrt(0.75), 0.0);
  EXPECT_NEAR(after.dot(across), 10.0 * 0.5, 1e-12);
}

/// Ways in plan between the stems that blocks meet in the air, high above flat ground.
TEST(ForestStems, FreePathsAreExponential) {
  Hillside hill(0.0, 8.0, 400);
  hill.effects.forest_stems = {.density = 300.0, .diameter = 0.3, .height = 1e9, .species_factor = 1e-9, .where = {}};
  const double mean = 1e4 / (300.0 * (0.3 + 1.2));
  Moments first, all;
  int beyond = 0;
  for (std::uint32_t block = 0; block < 4000; ++block) {
    const Path path = hill.run(block_at({20.0, 1600.0, 1400.0}, {80.0, 0.0, 0.0}, 1.2, block));
    double from = 20.0;
    for (const Vertex& v : path.vertices) {
      if (v.event == Event::Impact) break;
      if (v.event != Event::Stem) continue;
      const double x = v.motion.position.x();
      if (from == 20.0) first.add(x - from);
      if (from == 20.0 && x - from > 2.0 * mean) ++beyond;
      if (from < 220.0) all.add(x - from);  // the flight is 720 m long: the next stem is always seen
      from = x;
    }
  }
  EXPECT_EQ(first.count, 4000.0);
  EXPECT_NEAR(first.mean(), mean, 5.0 * mean / std::sqrt(4000.0));
  EXPECT_NEAR(all.mean(), mean, 5.0 * mean / std::sqrt(all.count));
  EXPECT_GT(all.count, 30'000.0);
  const double p = std::exp(-2.0);
  EXPECT_NEAR(beyond / 4000.0, p, 5.0 * std::sqrt(p * (1.0 - p) / 4000.0));
}

TEST(ForestStems, AStrongStemStopsABlockAndItDrops) {
  Hillside hill(0.0);
  hill.effects.forest_stems = {.density = 400.0, .diameter = 0.6, .height = 1e3, .species_factor = 1e6, .where = {}};
  int stopped = 0;
  for (std::uint32_t block = 0; block < 1000; ++block) {
    const Path path = hill.run(block_at({20.0, 400.0, 1500.0}, {20.0, 0.0, 0.0}, 0.5, block));
    const auto stem = std::find_if(path.vertices.begin(), path.vertices.end(),
                                   [](const Vertex& v) { return v.event == Event::Stem; });
    ASSERT_NE(stem, path.vertices.end());
    if (stem->motion.velocity.norm() > 0.0) continue;
    ++stopped;
    ASSERT_EQ((stem + 1)->motion.position.head<2>(), stem->motion.position.head<2>());  // it falls along the stem
  }
  const double p = 0.58 + std::log10(1.026 / 0.046 - 1.0) / 8.007;  // the share is above 0 for |e| below
  EXPECT_NEAR(stopped / 1000.0, p, 5.0 * std::sqrt(p * (1.0 - p) / 1000.0));
}

TEST(ForestStems, AboveTheTreesNoneIsMet) {
  Hillside hill(0.0);
  hill.effects.forest_stems = {.density = 2000.0, .diameter = 0.6, .height = 20.0, .where = {}};
  const Path path = hill.run(block_at({20.0, 400.0, 1100.0}, {40.0, 0.0, 0.0}));
  for (const Vertex& v : path.vertices)
    if (v.event == Event::Stem) {
      ASSERT_LT(v.motion.position.z(), 1020.0 + 1e-9);
    }
}

/// A block of 1 m slides through a stand on a smooth slope of 3 in 4. A slide that meets no stem ends with
/// v^2 = v0^2 + 2 g fall - 2 tan(phi) g cos(b) way; so a lower speed has an event. A stem is on the way w in plan with
/// the probability 1 - exp(-w / mean way), whatever was met before.
TEST(ForestStems, AStemInASlideHasAnEvent) {
  Hillside hill(0.75, 2.0);
  hill.cover.grounds[0] = {.theta_scale = 0.0, .psi_scale = 0.0, .shape_min = 1.0, .shape_max = 1.0};
  hill.effects.forest_stems = {.density = 2000.0, .diameter = 0.1, .height = 1e3, .where = {}};
  const double mean = 1e4 / (2000.0 * (0.1 + 1.0)), friction = hill.cover.grounds[0].tan_phi * kGravity * 0.8;
  const Vec3 normal(0.6, 0.0, 0.8);
  double hits = 0.0, expected = 0.0, variance = 0.0;
  for (std::uint32_t block = 0; block < 100; ++block) {
    const Path path = hill.run(block_at({20.0, 200.0, 985.0}, Vec3::Zero(), 1.0, block));
    for (std::size_t i = 0; i + 1 < path.vertices.size(); ++i) {
      if (path.vertices[i].event != Event::Impact || path.vertices[i + 1].event != Event::Slide) continue;
      const Motion& first = path.vertices[i].motion;
      double way = 0.0;
      for (++i; i + 1 < path.vertices.size() && path.vertices[i].event == Event::Slide; ++i)
        way += (path.vertices[i + 1].motion.position - path.vertices[i].motion.position).norm();
      const Vertex& end = path.vertices[i];
      if (end.event == Event::End) break;
      const Vec3 gone = end.motion.position - first.position;
      const double p = 1.0 - std::exp(-gone.head<2>().norm() / mean);
      expected += p, variance += p * (1.0 - p), hits += end.event == Event::Stem ? 1.0 : 0.0;
      const double at_start = (first.velocity - first.velocity.dot(normal) * normal).squaredNorm();
      const double squared = at_start - 2.0 * kGravity * gone.z() - 2.0 * friction * way;
      if (end.event != Event::Stem) {
        ASSERT_NEAR(end.motion.velocity.squaredNorm(), squared, 1e-3 * squared);
      }
      --i;  // it may be an impact
    }
  }
  EXPECT_GT(expected, 500.0);
  EXPECT_NEAR(hits, expected, 5.0 * std::sqrt(variance));
}

/// A forest whose cells are all alike is a uniform stand, bit for bit.
TEST(ForestStems, EqualCellsAreAUniformStand) {
  Hillside uniform(0.8), cells(0.8);
  uniform.cover.grounds[0] = cells.cover.grounds[0] = {.theta_scale = 0.4, .psi_scale = 0.3};
  uniform.effects.forest_stems = {.density = 300.0, .diameter = 0.25, .where = {}};  // both are floats
  cells.effects.forest_stems = {.density = 300.0, .diameter = 0.1, .where = {}};
  auto map = std::make_shared<ForestMap>();
  map->density = Raster<float>(cells.surface.grid(), 300.0F);
  map->diameter = Raster<float>(cells.surface.grid(), 0.25F);
  cells.effects.forest_stems.map = map;
  int stems = 0;
  for (std::uint32_t block = 0; block < 200; ++block) {
    const Release release = block_at({20.0, 400.0, 990.0}, {3.0, 0.5, 0.0}, 1.0, block);
    const Path path = uniform.run(release);
    for (const Vertex& v : path.vertices) stems += v.event == Event::Stem ? 1 : 0;
    ASSERT_TRUE(same_bits(path, cells.run(release))) << block;
  }
  EXPECT_GT(stems, 500);
}

/// Cells in a chequer of densities and thicknesses: the way to the first stem has the distribution whose rate is that
/// of the cell, P(beyond) = exp(-sum of length / mean way), at every cell edge.
TEST(ForestStems, TheRateIsThatOfEachCell) {
  Hillside hill(0.0, 8.0, 400);
  auto map = std::make_shared<ForestMap>();
  map->density = Raster<float>(hill.surface.grid(), 0.0F);
  map->diameter = Raster<float>(hill.surface.grid(), 0.5F);
  const auto density_of = [](int column) { return column % 3 == 0 ? 0.0 : column % 3 == 1 ? 200.0 : 600.0; };
  const auto diameter_of = [](int column) { return column % 2 == 0 ? 0.5 : 1.0; };
  for (int row = 0; row < 400; ++row)
    for (int column = 0; column < 400; ++column) {
      map->density.at(column, row) = static_cast<float>(density_of(column));
      map->diameter.at(column, row) = static_cast<float>(diameter_of(column));
    }
  hill.effects.forest_stems = {
      .density = 600.0, .height = 1e9, .species_factor = 1e-9, .where = {}, .map = std::move(map)};
  constexpr int kBlocks = 6000, kEdges = 12;
  std::array<int, kEdges> beyond{};
  for (std::uint32_t block = 0; block < kBlocks; ++block) {
    const Path path = hill.run(block_at({24.0, 1600.0, 3000.0}, {80.0, 0.0, 0.0}, 1.2, block));
    const auto stem = std::find_if(path.vertices.begin(), path.vertices.end(),
                                   [](const Vertex& v) { return v.event == Event::Stem; });
    ASSERT_NE(stem, path.vertices.end());
    for (int edge = 0; edge < kEdges; ++edge) beyond[edge] += stem->motion.position.x() > 8.0 * (4 + edge) ? 1 : 0;
  }
  double depth = 0.0;
  for (int edge = 0; edge < kEdges; ++edge) {
    depth += 8.0 * 1e-4 * density_of(3 + edge) * (diameter_of(3 + edge) + 1.2);
    const double p = std::exp(-depth);
    EXPECT_NEAR(beyond[edge] / double{kBlocks}, p, 5.0 * std::sqrt(p * (1.0 - p) / kBlocks) + 1e-12) << edge;
  }
}

/// Where the raster has no forest the flight is the plain one, bit for bit.
TEST(ForestStems, CellsWithoutAForestKeepEveryBit) {
  Hillside plain(0.8), acting(0.8);
  plain.acting = false;
  auto map = std::make_shared<ForestMap>();
  map->density = Raster<float>(acting.surface.grid(), 0.0F);
  map->density.at(199, 199) = 800.0F;
  acting.effects.forest_stems = {.density = 800.0, .where = {}, .map = std::move(map)};
  for (std::uint32_t block = 0; block < 50; ++block) {
    const Release release = block_at({20.0, 200.0, 990.0}, {3.0, 0.5, 0.0}, 1.0, block);
    ASSERT_TRUE(same_bits(plain.run(release), acting.run(release))) << block;
  }
}

}  // namespace
}  // namespace talus
