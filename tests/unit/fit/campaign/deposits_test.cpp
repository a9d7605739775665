#include "talus/fit/campaign/deposits.hpp"

#include <numeric>

#include "fit/campaign/nearest_source.hpp"
#include "support/campaigns.hpp"

namespace talus::test {
namespace {

/// A plane that falls by `slope` to the east, with two sources near its top, the second of three times the area.
Campaign plane_with_sources(double slope) {
  Campaign c;
  const Grid grid = grid_of(60, 30, 2.0, 3.0);
  c.surface = Surface(terrain(grid, [slope](double x, double) { return 100.0 - slope * x; }));
  c.zone_names = {"default"};
  c.deposits = std::make_shared<const MappedDeposits>(
      mapped_deposits({{{5.0, 31.5, 100.0 - slope * 5.0}, 10.0}, {{5.0, 61.5, 100.0 - slope * 5.0}, 30.0, true}},
                      Raster<std::uint8_t>(grid, std::uint8_t{1})));
  return c;
}

MeasuredBlock mapped_block(const std::string& id, double x, double y) {
  MeasuredBlock block;
  block.id = id;
  block.stream = stream_of_name(id);
  block.stop = Eigen::Vector2d(x, y);
  return block;
}

/// The source found cell by cell is as near as the nearest of all sources.
TEST(Deposits, TheNearestSourceIsThatOfASearchThroughAll) {
  Numbers numbers(7);
  for (const double density : {0.001, 0.02, 0.3}) {
    const Grid grid = grid_of(53, 41, 2.0, 3.5);
    Raster<std::uint32_t> sources(grid, kNoSource);
    std::vector<std::size_t> cells;
    for (std::size_t i = 0; i < grid.cells(); ++i)
      if (numbers.uniform(0.0, 1.0) < density || i == 777) {
        sources.values[i] = static_cast<std::uint32_t>(cells.size());
        cells.push_back(i);
      }
    const Raster<std::uint32_t> nearest = nearest_sources(sources);
    const auto centre = [&](std::size_t i) {
      const int columns = grid.columns, at = static_cast<int>(i);
      return Eigen::Vector2d(grid.centre_x(at % columns), grid.centre_y(at / columns));
    };
    for (std::size_t i = 0; i < grid.cells(); ++i) {
      double least = 1e9;
      for (const std::size_t cell : cells) least = std::min(least, (centre(cell) - centre(i)).norm());
      ASSERT_NEAR((centre(cells[nearest.values[i]]) - centre(i)).norm(), least, 1e-9) << i;
    }
  }
}

/// On a plane every place below a source has the angle of the plane, and the distance of plane geometry.
TEST(Deposits, RunOutOnAPlane) {
  const Campaign c = plane_with_sources(0.7);
  const RunOut straight = run_out(c, {85.0, 31.5});
  EXPECT_NEAR(straight.distance, 80.0, 1e-9);
  EXPECT_NEAR(straight.angle, std::atan(0.7), 1e-6);  // heights are floats
  const RunOut aside = run_out(c, {65.0, 31.5 - 30.0});
  EXPECT_NEAR(aside.distance, std::hypot(60.0, 30.0), 1e-9);
  EXPECT_NEAR(std::tan(aside.angle), 0.7 * 60.0 / std::hypot(60.0, 30.0), 1e-6);
  EXPECT_TRUE(std::isnan(run_out(c, {6.0, 32.0}).angle));
  EXPECT_TRUE(std::isnan(run_out(c, {-5.0, 32.0}).distance));
  EXPECT_NEAR(run_out(c, {5.0, 72.0}).distance, 10.5, 1e-9) << "of the other source, which is nearer";
}

/// A source of three times the area releases three times the blocks, evenly in its cell; a point exactly there.
TEST(Deposits, SourcesReleaseByTheirArea) {
  Campaign c = plane_with_sources(0.7);
  c.blocks = {mapped_block("a", 60.0, 30.0)};
  constexpr int kDraws = 20000;
  double first = 0.0, x = 0.0, y = 0.0;
  for (std::uint32_t t = 0; t < kDraws; ++t) {
    const Vec3 p = release_of(c, 0, 1, t).motion.position;
    ASSERT_NEAR(p.z() - *c.surface.height(p.x(), p.y()), 1.0, 1e-9);
    if (p.y() > 45.0) {
      ASSERT_EQ(p.x(), 5.0);
      ASSERT_EQ(p.y(), 61.5);
      continue;
    }
    first += 1.0;
    x += p.x() - 5.0;
    y += p.y() - 31.5;
    ASSERT_LE(std::abs(p.x() - 5.0), 1.0);
    ASSERT_LE(std::abs(p.y() - 31.5), 1.5);
  }
  EXPECT_NEAR(first / kDraws, 0.25, 5.0 * std::sqrt(0.25 * 0.75 / kDraws));
  EXPECT_NEAR(x / first, 0.0, 5.0 * (2.0 / std::sqrt(12.0)) / std::sqrt(first));
  EXPECT_NEAR(y / first, 0.0, 5.0 * (3.0 / std::sqrt(12.0)) / std::sqrt(first));
}

/// Stops are those of the whole plane, but for those outside the region of the block.
TEST(Deposits, OnlyStopsInTheRegionOfTheBlockCount) {
  Campaign whole = campaign_on_slope(2);
  whole.error = {};
  whole.screens.clear();
  const Grid grid = whole.surface.grid();
  const double top = *whole.surface.height(21.0, 71.0);
  Raster<std::uint8_t> one(grid, std::uint8_t{1}), parts(grid, std::uint8_t{0});
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column)
      if (grid.centre_x(column) > 130.0) parts.at(column, row) = grid.centre_y(row) < 70.0 ? 1 : 2;
  Campaign cut = whole;
  whole.blocks = cut.blocks = {mapped_block("a", 150.0, 40.0), mapped_block("b", 150.0, 100.0)};
  const std::vector<DepositSource> source{{{21.0, 71.0, top}, 1.0}};
  whole.deposits = std::make_shared<const MappedDeposits>(mapped_deposits(source, one));
  cut.deposits = std::make_shared<const MappedDeposits>(mapped_deposits(source, parts));
  ObserveOptions how;
  how.trials = 200;
  const auto all = observe(whole, model_of_slope(), how), some = observe(cut, model_of_slope(), how);
  std::array<int, 2> kept{}, stopped{};
  for (std::size_t b = 0; b < 2; ++b)
    for (std::size_t t = 0; t < 200; ++t) {
      if (std::isnan(all[b].x[t])) continue;
      ++stopped[b];
      const bool inside = all[b].x[t] > 130.0 && (all[b].y[t] < 70.0) == (b == 0);
      if (std::abs(all[b].x[t] - 130.0) > 2.0 && std::abs(all[b].y[t] - 70.0) > 2.0)  // cells, not lines
        ASSERT_EQ(!std::isnan(some[b].x[t]), inside) << all[b].x[t] << ' ' << all[b].y[t];
      if (std::isnan(some[b].x[t])) continue;
      ++kept[b];
      ASSERT_EQ(some[b].x[t], all[b].x[t]);
    }
  for (std::size_t b = 0; b < 2; ++b) EXPECT_GT(kept[b], 10);
  EXPECT_LT(kept[0] + kept[1], stopped[0] + stopped[1]);
}

TEST(Deposits, ClassesOfSizeHoldEnoughBlocks) {
  std::vector<double> sizes(90);
  std::iota(sizes.begin(), sizes.end(), 1.0);
  EXPECT_EQ(class_limits(sizes), (std::vector<double>{30.5, 60.5}));
  EXPECT_EQ(class_limits({sizes.begin(), sizes.begin() + 50}), (std::vector<double>{25.5}));
  EXPECT_TRUE(class_limits({sizes.begin(), sizes.begin() + 39}).empty());
  EXPECT_TRUE(class_limits(std::vector<double>(90, 0.5)).empty()) << "equal blocks are one class";
  std::vector<double> rounded(21, 0.5);  // as they are in the field
  rounded.resize(60, 1.0);
  EXPECT_EQ(class_limits(rounded), std::vector<double>{0.75});
  rounded.resize(62, 1.4);
  EXPECT_EQ(class_limits(rounded), std::vector<double>{0.75}) << "two blocks are no class";
  rounded.assign(19, 0.5);
  rounded.resize(60, 1.0);
  EXPECT_TRUE(class_limits(rounded).empty());
}

/// A diameter that was written becomes a mass, and the mass a diameter again: blocks at a limit are in the class from
/// it on, and blocks of one written diameter are one class, whatever their densities.
TEST(Deposits, ClassesAreThoseOfTheDiametersThatWereWritten) {
  const auto read = [](double diameter, double density) {
    return equivalent_diameter(density * kPi / 6.0 * diameter * diameter * diameter, density);
  };
  for (int centimetres = 5; centimetres <= 1000; ++centimetres) {
    const double written = centimetres / 100.0;
    MappedDeposits deposits;
    deposits.limits = {written};
    std::vector<double> alike;
    for (double density = 2000.0; density < 3000.0; density += 50.0) {
      const double diameter = read(written, density);
      ASSERT_EQ(class_of(deposits, diameter), 1U) << written << " m, " << density << " kg/m3";
      ASSERT_EQ(class_of(deposits, read(written - 0.001, density)), 0U) << written << " m, " << density << " kg/m3";
      alike.insert(alike.end(), 3, diameter);
    }
    ASSERT_TRUE(class_limits(alike).empty()) << written;
  }
}

/// Strips run down the slope: places at one height lie in different ones, places in one fall line in the same.
TEST(Deposits, StripsCutAcrossTheSlope) {
  const Campaign c = plane_with_sources(0.7);
  std::vector<Eigen::Vector2d> places;
  for (int i = 0; i < 40; ++i) places.emplace_back(60.0 + 7.0 * (i % 3), 34.0 + i);  // mean 53.5, near the sources' 54
  const Strips strips = strips_of(*c.deposits, places, 4);
  std::array<int, 4> count{};
  for (const Eigen::Vector2d& place : places) ++count[strips.of(place)];
  EXPECT_EQ(count, (std::array<int, 4>{10, 10, 10, 10}));
  EXPECT_EQ(strips.of({30.0, 38.0}), strips.of({90.0, 38.0}));
  EXPECT_NE(strips.of({60.0, 34.0}), strips.of({60.0, 70.0}));
}

}  // namespace
}  // namespace talus::test
