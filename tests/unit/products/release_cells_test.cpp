#include "talus/products/release_cells.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "support/scenarios.hpp"

namespace talus {
namespace {

TEST(ReleaseCells, ByHand) {
  Raster<float> heights = test::terrain(test::grid_of(4, 3, 2.0, 2.0), [](double, double) { return 1.0; });
  heights.at(3, 2) = std::numeric_limits<float>::quiet_NaN();
  Scenario s = test::scenario_on(heights);
  s.sources = {{0, 5.0, 3.0, false}, {0, 1.0, 3.0, false}, {0, 0.3, 2.1, true}};  // two points and cells in (0, 1)
  s.trajectories = 20;
  const ReleaseCells cells(s);
  std::vector<double> row(4);
  cells.fill({0, 1, 4, 1}, row);
  EXPECT_EQ(row, (std::vector<double>{40.0, 0.0, 20.0, 0.0}));
  cells.fill({0, 0, 4, 1}, row);
  EXPECT_EQ(row, (std::vector<double>(4, 0.0)));
  cells.fill({0, 2, 4, 1}, row);
  EXPECT_TRUE(std::isnan(row[3]));
  EXPECT_EQ(row[0], 0.0);
}

}  // namespace
}  // namespace talus
