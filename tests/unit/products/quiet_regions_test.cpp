#include "talus/products/quiet_regions.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "support/scenarios.hpp"
#include "talus/products/maps.hpp"
#include "talus/simulate/simulate.hpp"

namespace talus {
namespace {

TEST(QuietRegions, AreNumberedRowByRowFromTheSouthWest) {
  std::vector<CellWindow> seen;
  const QuietRegions regions(test::grid_of(130, 70, 1.0, 1.0), [&](std::size_t region, const CellWindow& window) {
    EXPECT_EQ(region, seen.size());
    seen.push_back(window);
    return region == 1 ? Quiet::No : region == 5 ? Quiet::NoTerrain : Quiet::Terrain;
  });
  ASSERT_EQ(seen.size(), 6U);  // 64 + 64 + 2 columns, 64 + 6 rows
  EXPECT_EQ(seen[5].column, 128);
  EXPECT_EQ(seen[5].row, 64);
  EXPECT_EQ(seen[5].columns, 2);
  EXPECT_EQ(seen[5].rows, 6);
  EXPECT_EQ(regions.of({0, 0, 64, 70}), Quiet::Terrain);
  EXPECT_EQ(regions.of({63, 0, 2, 1}), Quiet::No);    // one cell of region 1
  EXPECT_EQ(regions.of({64, 63, 64, 7}), Quiet::No);  // its last row
  EXPECT_EQ(regions.of({64, 64, 64, 6}), Quiet::Terrain);
  EXPECT_EQ(regions.of({128, 64, 2, 6}), Quiet::NoTerrain);
  EXPECT_EQ(regions.of({120, 64, 10, 6}), Quiet::No);  // with and without terrain
}

TEST(QuietRegions, AMapKnowsNothingThatItsCellsDoNotHave) {
  Raster<float> heights = test::terrain(test::grid_of(200, 140, 1.0, 1.0), [](double x, double) { return 0.8 * x; });
  for (int row = 0; row < 64; ++row)
    for (int column = 0; column < 70; ++column) heights.at(column, row) = std::numeric_limits<float>::quiet_NaN();
  Scenario s = test::scenario_on(heights);
  s.sources.assign(1, {0, 190.5, 130.5, false});
  s.trajectories = 10;
  Tally tally(s.surface.grid(), s.output.energy_thresholds, s.output.height_thresholds);
  simulate(s, tally, {}, 1);
  int known = 0;
  for (const Map& map : make_maps(s, tally))
    for (int row = 0; row < 140; row += 20)
      for (int column = 0; column < 200; column += 20) {
        const CellWindow window{column, row, 20, 20};
        const auto all = map.everywhere(window);
        if (!all) continue;
        ++known;
        std::vector<double> values(window.cells() * map.bands.size());
        map.fill(window, values);
        for (std::size_t i = 0; i < values.size(); ++i) {
          const double expected = (*all)[i % map.bands.size()];
          ASSERT_TRUE(values[i] == expected || (std::isnan(values[i]) && std::isnan(expected))) << map.name;
        }
      }
  EXPECT_GT(known, 100);
}

}  // namespace
}  // namespace talus
