#include "talus/products/gully_stops.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/scenes.hpp"

namespace talus {
namespace {

/// A gully along the rows: floor 35 degrees to the east, walls of 45 degrees, thalweg through the centres of row 5.
Scenario gully() {
  Scenario scenario;
  scenario.surface = Surface(test::terrain(test::grid_of(20, 11, 5.0, 5.0),
                                           [](double x, double y) { return 500.0 - 0.7 * x + std::abs(y - 27.5); }));
  scenario.cover.grounds = {Ground{}};
  return scenario;
}

StopRow stop(double x, double y, End end) {
  StopRow row{};
  row.x = x, row.y = y, row.end = end;
  return row;
}

TEST(GullyStops, CountsThoseThatStopOrAreTrappedInTheGully) {
  const Scenario scenario = gully();
  GullyStops stops(scenario);
  EXPECT_EQ(stops.blocks(), 0U);
  EXPECT_FALSE(stops.worst());
  std::vector<StopRow> rows;
  for (const End end : {End::Stopped, End::Trapped, End::Left, End::Caught, End::Limit})
    rows.push_back(stop(52.0, 28.0, end));
  rows.push_back(stop(52.0, 12.0, End::Stopped));   // on the wall
  rows.push_back(stop(100.0, 28.0, End::Stopped));  // on the eastern edge of the grid
  rows.push_back(stop(33.0, 26.0, End::Stopped));
  stops.add(rows);
  EXPECT_EQ(stops.blocks(), 3U);
  EXPECT_EQ(stops.worst()->column, 10);
  EXPECT_EQ(stops.worst()->row, 5);
  EXPECT_EQ(stops.worst()->blocks, 2U);
}

TEST(GullyStops, AreTheSameInAnyOrder) {
  const Scenario scenario = gully();
  GullyStops one(scenario), other(scenario);
  const StopRow west = stop(27.0, 27.0, End::Stopped), east = stop(47.0, 27.0, End::Stopped);
  one.add(std::vector{west, east});
  other.add(std::vector{east});
  other.add(std::vector{west});
  for (const GullyStops* stops : {&one, &other}) {
    EXPECT_EQ(stops->blocks(), 2U);
    EXPECT_EQ(stops->worst()->column, 5);  // of equal ones the westernmost
  }
}

TEST(GullyStops, GoByTheFrictionOfTheGroundThere) {
  Scenario scenario = gully();
  scenario.cover.grounds.push_back(Ground{.tan_phi = 0.8});  // steeper than the floor of the gully
  scenario.cover.zones = Raster<std::uint8_t>(scenario.surface.grid(), std::uint8_t{0});
  scenario.cover.zones.at(10, 5) = 1;
  GullyStops stops(scenario);
  stops.add(std::vector{stop(52.0, 27.0, End::Stopped), stop(57.0, 27.0, End::Stopped)});
  EXPECT_EQ(stops.blocks(), 1U);
}

}  // namespace
}  // namespace talus
