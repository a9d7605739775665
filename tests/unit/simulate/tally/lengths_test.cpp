// Plan lengths in the cells: closed forms, conservation, and the same sums on any grid.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "support/scenarios.hpp"
#include "talus/physics/flight.hpp"
#include "talus/simulate/simulate.hpp"

namespace talus {
namespace {

using test::Numbers;

constexpr double kMass = 2000.0;  // [kg]: the energy in kJ is the square of the speed

/// Length in metres and above each threshold of a rectangle of cells, both corners included.
std::vector<double> lengths_in(const Tally& tally, std::array<int, 2> from, std::array<int, 2> to) {
  const std::size_t thresholds = tally.thresholds()[Quantity::Energy].size();
  std::vector<double> sums(1 + thresholds);
  for (int row = from[1]; row <= to[1]; ++row)
    for (int column = from[0]; column <= to[0]; ++column) {
      const CellRecord* cell = tally.find(column, row);
      if (cell == nullptr) continue;
      sums[0] += static_cast<double>(cell->length) * CellRecord::kLengthUnit;
      for (std::size_t i = 0; i < thresholds; ++i)
        sums[1 + i] += static_cast<double>(tally.lengths_above(column, row)[i]) * CellRecord::kLengthUnit;
    }
  return sums;
}

std::vector<double> lengths_of(const Tally& tally) {
  return lengths_in(tally, {0, 0}, {tally.grid().columns - 1, tally.grid().rows - 1});
}

struct Flight {
  Vec3 position, velocity;
};

Path path_of(const Surface& surface, const Flight& flight) {
  Motion motion;
  motion.position = flight.position;
  motion.velocity = flight.velocity;
  PatchIndex at = surface.patch_at(motion.position.x(), motion.position.y());
  Path path;
  path.end = fly(surface, motion, at, false, path) == FlightEnd::Landed ? End::Stopped : End::Left;
  return path;
}

Tally tally_of(const Surface& surface, const std::vector<Flight>& flights, const LengthRules& rules) {
  Tally tally(surface.grid(), rules.energies, {});
  VisitBatch batch(surface.grid(), rules);
  for (const Flight& flight : flights) batch.add(path_of(surface, flight), kMass, 0, nullptr);
  tally.add(batch);
  return tally;
}

Surface plain(double cell) {
  const int side = static_cast<int>(std::lround(96.0 / cell));
  return Surface(test::terrain(test::grid_of(side, side, cell, cell), [](double, double) { return 0.0; }));
}

/// n straight paths across a strip of width B have the density n / B, whatever the direction and the cell.
TEST(Lengths, AStraightFlowOfPathsAcrossAStrip) {
  constexpr int kPaths = 24;
  constexpr double kStrip = 24.0;  // [m]
  for (const double cell : {1.0, 2.0, 4.0})
    for (const double angle : {0.0, 0.3}) {
      const Surface surface = plain(cell);
      const Eigen::Vector2d along(std::cos(angle), std::sin(angle)), across(-along.y(), along.x());
      std::vector<Flight> flights;
      for (int i = 0; i < kPaths; ++i) {  // parallel, evenly spread over the strip, which is centred on (48, 48)
        const Eigen::Vector2d from =
            Eigen::Vector2d(48, 48) - 40.0 * along + (kStrip * (i + 0.5) / kPaths - 12.0) * across;
        flights.push_back({{from.x(), from.y(), 900.0}, {30.0 * along.x(), 30.0 * along.y(), 0.0}});
      }
      const Tally tally = tally_of(surface, flights, {});
      const int low = static_cast<int>(40.0 / cell),
                high = static_cast<int>(56.0 / cell) - 1;  // 16 x 16 m in the strip
      const double density = lengths_in(tally, {low, low}, {high, high})[0] / 256.0;
      EXPECT_NEAR(density, kPaths / kStrip, angle == 0.0 ? 1e-5 : 0.01) << cell << ' ' << angle;
    }
}

/// A flight over a plain from 4 m, 10 m/s upwards: v^2 = 225 + (10 - g t)^2, so it is above 400 from
/// t = (10 + sqrt(175)) / g on, and above 260 but between t = (10 - sqrt(35)) / g and t = (10 + sqrt(35)) / g.
TEST(Lengths, AboveAnEnergyInFlight) {
  for (const double cell : {1.0, 4.0, 16.0}) {
    const Surface surface = plain(cell);
    const Flight flight{{10.0, 20.0, 4.0}, {12.0, 9.0, 10.0}};
    const double end = (10.0 + std::sqrt(100.0 + 8.0 * kGravity)) / kGravity;
    const std::vector<double> length = lengths_of(tally_of(surface, {flight}, {{230.0, 260.0, 400.0}}));
    const auto without = [&](double limit) {  // time between the two moments at which the energy is the limit
      return 2.0 * std::sqrt(limit - 225.0) / kGravity;
    };
    EXPECT_NEAR(length[0], 15.0 * end, 2e-5) << cell;
    EXPECT_NEAR(length[1], 15.0 * (end - without(230.0)), 4e-5) << cell;
    EXPECT_NEAR(length[2], 15.0 * (end - without(260.0)), 4e-5) << cell;
    EXPECT_NEAR(length[3], 15.0 * (end - (10.0 + std::sqrt(175.0)) / kGravity), 4e-5) << "before it lands: " << cell;
  }
}

/// The same flight: lower than 6 m above the plain before and after two times of its parabola.
TEST(Lengths, BelowAHeight) {
  for (const double cell : {1.0, 4.0, 16.0}) {
    const Surface surface = plain(cell);
    const Flight flight{{10.0, 20.0, 4.0}, {12.0, 9.0, 10.0}};
    const double end = (10.0 + std::sqrt(100.0 + 8.0 * kGravity)) / kGravity;
    const double above = 2.0 * std::sqrt(100.0 - 4.0 * kGravity) / kGravity;  // 4 + 10 t - g t^2 / 2 > 6
    const std::vector<double> length = lengths_of(tally_of(surface, {flight}, {{260.0}, 6.0}));
    EXPECT_NEAR(length[0], 15.0 * (end - above), 4e-5) << cell;
    const double slow = 2.0 * std::sqrt(35.0) / kGravity;  // below 260; within `above`, or around it, about the apex
    EXPECT_NEAR(length[1], 15.0 * (end - std::max(above, slow)), 4e-5) << cell;
  }
}

/// A slide that speeds up evenly from 2 to 4 m/s over 6 m: v^2 is linear in the way, and above 10 on its second half.
TEST(Lengths, AboveAnEnergyInASlide) {
  const Grid grid = test::grid_of(4, 4, 8.0, 8.0);
  Path path;
  path.spans.push_back({{0, 0}, 0.125F, 0.25F, 0.875F, 0.25F, 0.0F, 0.0F, 0.0F, 0.0F, 2.0F, 4.0F, 0});
  path.end = End::Left;
  Tally tally(grid, {10.0, 15.0}, {});
  VisitBatch batch(grid, {{10.0, 15.0}});
  batch.add(path, kMass, 0, nullptr);
  tally.add(batch);
  EXPECT_NEAR(lengths_in(tally, {0, 0}, {0, 0})[0], 3.0, 1e-5) << "the span crosses the border of the cells half way";
  EXPECT_NEAR(lengths_in(tally, {0, 0}, {0, 0})[1], 0.0, 1e-5);
  EXPECT_NEAR(lengths_in(tally, {1, 0}, {1, 0})[1], 3.0, 1e-5);
  EXPECT_NEAR(lengths_in(tally, {1, 0}, {1, 0})[2], 0.5, 1e-5);
}

/// Sums over 4 x 4 cells of 1 m are those of the cell of 4 m, at every level.
TEST(Lengths, TheSameOnAFinerGrid) {
  Numbers numbers(3);
  std::vector<Flight> flights;
  for (int i = 0; i < 100; ++i)
    flights.push_back(
        {{numbers.uniform(10, 80), numbers.uniform(10, 80), numbers.uniform(1, 30)}, numbers.vector(12.0)});
  const LengthRules rules{{50.0, 150.0, 300.0}, 9.0};
  const Tally coarse = tally_of(plain(4.0), flights, rules), fine = tally_of(plain(1.0), flights, rules);
  for (int row = 1; row < 23; ++row)  // at the edge half a cell has no terrain
    for (int column = 1; column < 23; ++column) {
      const std::vector<double> one = lengths_in(coarse, {column, row}, {column, row});
      const std::vector<double> many = lengths_in(fine, {4 * column, 4 * row}, {4 * column + 3, 4 * row + 3});
      for (std::size_t level = 0; level < one.size(); ++level)
        ASSERT_NEAR(one[level], many[level], 5e-4) << column << ' ' << row << ' ' << level;
    }
}

TEST(Lengths, AddUpToTheWayOfAllBlocks) {
  const Scenario s = make_scenario(test::rough_slope(6, 150));
  Tally tally(s.surface.grid(), s.output.energy_thresholds, s.output.height_thresholds);
  const Totals totals = simulate(s, tally, {}, 2);
  const double way = 1e-3 * static_cast<double>(totals.plan_length_mm);
  EXPECT_GT(way, 1e4);
  EXPECT_NEAR(lengths_of(tally)[0], way, 1e-5 * way);
}

/// The square is of the whole length of a block in the cell, also where it comes back.
TEST(Lengths, SquaresAreOfBlocks) {
  const Grid grid = test::grid_of(8, 8, 8.0, 8.0);
  Tally tally(grid, {}, {});
  VisitBatch batch(grid);
  const Span way = test::stay(2, 2, 1.0F, 1.0F), away = test::stay(3, 2, 1.0F, 1.0F);  // sqrt(2) m each
  batch.add(test::path_of({way, away, way}, End::Left), 1.0, 0, nullptr);
  batch.add(test::path_of({way}, End::Left), 1.0, 0, nullptr);
  batch.add(test::path_of({way}, End::Left), 1.0, 0, nullptr, true);  // a piece of the block before it
  tally.add(batch);
  const CellRecord& cell = *tally.find(2, 2);
  EXPECT_NEAR(static_cast<double>(cell.length) * CellRecord::kLengthUnit, 4.0 * std::sqrt(2.0), 1e-5);
  EXPECT_NEAR(static_cast<double>(cell.length_squares) * CellRecord::kLengthUnit, 8.0 + 8.0, 1e-4);
}

/// By hand: two blocks of 1/4 event per year, of 1 and 2 m; lengths of sqrt(2) m.
TEST(Lengths, WeightedByFrequencyAndDiameter) {
  Scenario s = test::scenario_on(test::terrain(test::grid_of(8, 8, 8.0, 8.0), [](double, double) { return 0.0; }));
  s.sources.assign(1, {0, 20.0, 20.0, false});
  s.trajectories = 4;
  s.features[0].frequency = 1.0;
  s.output.energy_thresholds = {2.0};
  const AnnualWeights weights = AnnualWeights::of(s).value();
  Tally tally(s.surface.grid(), s.output.energy_thresholds, {});
  tally.keep_hazard(weights);
  VisitBatch batch(tally.grid(), length_rules(s.output));
  for (std::uint32_t block = 0; block < 2; ++block) {
    batch.set_annual_share({weights.weight(s, 0, block), 0, 4});
    batch.add(test::path_of({test::stay(2, 2, block == 0 ? 1.0F : 4.0F, 1.0F)}, End::Left),
              Block{1.0 + block, kMass, Vec3::Ones()}, 0, nullptr);
  }
  tally.add(batch);
  const auto levels = tally.hazard(2, 2)->lengths();
  ASSERT_EQ(levels.size(), 2U);
  const double way = std::sqrt(2.0), unit = tally.hazard_rules().scale.unit;
  EXPECT_NEAR(static_cast<double>(levels[0].length) * unit * WeightedLengths::kLengthUnit, 0.5 * way, 1e-6);
  EXPECT_NEAR(static_cast<double>(levels[0].by_diameter) * unit * WeightedLengths::kDiameterUnit, 0.75 * way, 1e-6);
  EXPECT_NEAR(static_cast<double>(levels[1].length) * unit * WeightedLengths::kLengthUnit, 0.25 * way, 1e-6);
  EXPECT_NEAR(static_cast<double>(levels[1].by_diameter) * unit * WeightedLengths::kDiameterUnit, 0.5 * way, 1e-6);
  EXPECT_NEAR(
      static_cast<double>(levels[0].squares) * tally.hazard_rules().scale.square_unit * WeightedLengths::kLengthUnit,
      0.125 * way, 1e-6);
}

}  // namespace
}  // namespace talus
