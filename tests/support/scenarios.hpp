#pragma once
#include <gtest/gtest.h>

#include <bit>
#include <initializer_list>

#include "percentile.hpp"
#include "scenes.hpp"
#include "talus/simulate/scenario/scenario.hpp"
#include "talus/simulate/tally/tally.hpp"

/// Scenarios, paths and tallies by hand for the tests of `simulate` and `products`.
namespace talus::test {

/// A scenario on a terrain: blocks of 1 m, one feature, one kind of ground, no source yet.
inline Scenario scenario_on(Raster<float> heights) {
  Scenario s;
  s.surface = Surface(std::move(heights));
  s.cover.grounds = {Ground{}};
  s.zone_names = {"default"};
  s.features = {SourceFeature{}};
  s.blocks.classes = {{{1.0, 1.0}, 1.0, kNotGiven}};
  return s;
}

inline constexpr std::uint32_t kSources = 5, kTrajectories = 300;  // three units of work to a source

inline Tally tally_of(const Scenario& s, MemoryPolicy memory = {}) {
  return {s.surface.grid(), s.output.energy_thresholds, s.output.height_thresholds, memory};
}

/// A slope of 42 degrees with bumps that runs out on a rough plain; `sources` cells near its top. The paths bounce,
/// slide, come back to cells, stop, and some leave the terrain.
inline Scenario rough_slope(std::uint32_t sources, std::uint32_t trajectories) {
  Numbers numbers(11);
  Scenario s = scenario_on(terrain(grid_of(100, 70, 2.0, 2.0), [&](double x, double) {
    return 200.0 - 0.9 * std::min(x, 120.0) - 0.2 * std::max(0.0, x - 120.0) + numbers.uniform(-0.3, 0.3);
  }));
  s.cover.grounds[0].theta_scale = 0.3;
  s.cover.grounds[0].psi_scale = 0.3;
  s.cover.grounds[0].En50 = 3.0;
  s.blocks.classes = {{{0.4, 1.2}, 1.0, kNotGiven}};
  s.features[0].release_height = {0.5, 3.0};
  for (std::uint32_t i = 0; i < sources; ++i) s.sources.push_back({0, 7.0 + 2.0 * (i % 3), 21.0 + 6.0 * i, false});
  s.trajectories = trajectories;
  return s;
}

/// The span of a short flight in one cell, at constant speed and height, as `fly` would make it.
inline Span stay(int column, int row, float speed_squared, float height, std::uint32_t impacts = 0) {
  return {{column, row}, 0.125F, 0.125F, 0.25F, 0.25F, height, height, 0.0F, speed_squared, 0.0F, 0.0F, impacts};
}

inline Path path_of(std::initializer_list<Span> spans, End end) {
  Path path;
  path.spans = spans;
  path.end = end;
  return path;
}

/// Three sources of known frequencies high on a smooth plane of 45 degrees: every block slides or jumps straight down
/// its own column. A cell below one source has the frequency of the source, a cell below two in line the sum.
inline Scenario three_sources() {
  Scenario s = scenario_on(terrain(grid_of(40, 40, 2.0, 2.0), [](double, double y) { return y; }));
  s.cover.grounds[0].theta_scale = 0.0;
  s.cover.grounds[0].psi_scale = 0.0;
  s.features.assign(3, SourceFeature{});
  s.features[0].frequency = 0.5;
  s.features[1].frequency = 0.02;
  s.features[2].frequency = 0.001;
  s.sources = {{0, 21.0, 71.0, true}, {1, 41.0, 71.0, true}, {2, 41.0, 61.0, true}};
  s.trajectories = 30;
  return make_scenario(std::move(s));
}

/// Checks that the records of all cells are equal, bit for bit.
inline void expect_same_records(const Tally& a, const Tally& b) {
  ASSERT_EQ(a.grid(), b.grid());
  EXPECT_EQ(a.touched_cells(), b.touched_cells());
  std::size_t thresholds = 0;
  for (const std::vector<double>& of : a.thresholds()) thresholds += of.size();
  for (int row = 0; row < a.grid().rows; ++row)
    for (int column = 0; column < a.grid().columns; ++column) {
      const CellRecord *left = a.find(column, row), *right = b.find(column, row);
      ASSERT_EQ(left == nullptr, right == nullptr) << column << ' ' << row;
      if (left == nullptr) continue;
      ASSERT_EQ(left->passages, right->passages) << column << ' ' << row;
      ASSERT_EQ(left->impacts, right->impacts) << column << ' ' << row;
      ASSERT_EQ(left->deposits, right->deposits) << column << ' ' << row;
      ASSERT_EQ(left->trapped, right->trapped) << column << ' ' << row;
      ASSERT_EQ(left->exits, right->exits) << column << ' ' << row;
      ASSERT_EQ(left->sources, right->sources) << column << ' ' << row;
      ASSERT_EQ(left->sum, right->sum) << column << ' ' << row;
      ASSERT_EQ(left->length, right->length) << column << ' ' << row;
      ASSERT_EQ(left->length_squares, right->length_squares) << column << ' ' << row;
      for (std::size_t i = 0; i < a.thresholds()[Quantity::Energy].size(); ++i)
        ASSERT_EQ(a.lengths_above(column, row)[i], b.lengths_above(column, row)[i]) << column << ' ' << row;
      ASSERT_EQ(left->maximum, right->maximum) << column << ' ' << row;
      for (std::size_t q = 0; q < kQuantities; ++q)
        for (const double share : {0.0, 0.1, 0.5, 0.9, 0.95, 0.99, 1.0})
          ASSERT_EQ(percentile(left->histogram[q], share), percentile(right->histogram[q], share));
      for (std::size_t i = 0; i < thresholds; ++i)
        ASSERT_EQ(a.exceedances(column, row)[i], b.exceedances(column, row)[i]) << column << ' ' << row;
    }
}

}  // namespace talus::test
