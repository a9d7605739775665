// Thresholds and hazard that count the energy with rotation: closed forms, equivalent paths, counts path by path.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/paths.hpp"
#include "support/scenarios.hpp"
#include "talus/physics/flight.hpp"
#include "talus/simulate/simulate.hpp"
#include "talus/simulate/tally_of.hpp"

namespace talus {
namespace {

using test::path_of;
using test::stay;

/// 1000 kg, 1 m: 0.5 kJ for each m^2/s^2, and 0.05 kJ w^2.
Block body_of(double mass = 1000.0, double diameter = 1.0) {
  Block body;
  body.mass = mass;
  body.diameter = diameter;
  return body;
}

AnnualWeights one_weight() {
  Scenario s = test::three_sources();
  return AnnualWeights::of(s).value();
}

/// The tally of paths of one block each, all of the same annual share.
Tally tally_with(const Grid& grid, const std::vector<Path>& paths, const std::vector<double>& thresholds,
                 bool with_rotation, const Block& body = body_of()) {
  Tally tally(grid, thresholds, {});
  if (with_rotation) tally.count_rotation();
  tally.keep_hazard(one_weight());
  VisitBatch batch(grid, {thresholds, kAnyHeight, with_rotation});
  std::uint64_t stratum = 0;
  for (const Path& path : paths) {
    batch.set_annual_share({1000, stratum++, 1});
    batch.add(path, body, 0, nullptr);
  }
  tally.add(batch);
  return tally;
}

double length_above(const Tally& tally, int column, int row, std::size_t threshold) {
  return static_cast<double>(tally.lengths_above(column, row)[threshold]) * CellRecord::kLengthUnit;
}

/// Weight of the passages above an energy threshold.
std::int64_t weight_above(const Tally& tally, int column, int row, std::size_t threshold) {
  const HazardCell& cell = *tally.hazard(column, row);
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < cell.bins().size(); ++i)
    if (cell.first() + static_cast<int>(i) >= tally.hazard_rules().bins.above(threshold)) sum += cell.bins()[i].weight;
  return sum;
}

/// A block of 50 kJ that spins with 20 kJ: above 60 kJ with rotation only, above 40 kJ always, above 80 kJ never.
TEST(CountRotation, ABlockOfKnownSpin) {
  Path path = path_of({stay(1, 1, 100, 1)}, End::Stopped);
  path.spins = {{0, 20.0}};
  const std::vector<double> thresholds{40.0, 60.0, 80.0};
  const Tally with = tally_with(test::grid_of(8, 8, 1.0, 1.0), {path}, thresholds, true),
              without = tally_with(test::grid_of(8, 8, 1.0, 1.0), {path}, thresholds, false);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(with.exceedances(1, 1)[i], i < 2 ? 1U : 0U) << thresholds[i];
    EXPECT_EQ(without.exceedances(1, 1)[i], i < 1 ? 1U : 0U) << thresholds[i];
    EXPECT_EQ(weight_above(with, 1, 1, i), i < 2 ? 1000 : 0) << thresholds[i];
    EXPECT_EQ(weight_above(without, 1, 1, i), i < 1 ? 1000 : 0) << thresholds[i];
    EXPECT_EQ(length_above(with, 1, 1, i) > 0.0, i < 2) << thresholds[i];
    EXPECT_EQ(length_above(without, 1, 1, i) > 0.0, i < 1) << thresholds[i];
  }
  EXPECT_EQ(with.find(1, 1)->maximum[Quantity::Energy], 50.0F) << "energy.tif stays translational";
  EXPECT_FLOAT_EQ(with.energy_total(1, 1)->maximum, 70.0F);
  EXPECT_TRUE(with.hazard_rules().with_rotation);
  EXPECT_FALSE(without.hazard_rules().with_rotation);
}

TEST(CountRotation, BetweenTwoNearThresholds) {  // 70 kJ
  Path path = path_of({stay(1, 1, 100, 1)}, End::Stopped);
  path.spins = {{0, 20.0}};
  const Tally tally = tally_with(test::grid_of(8, 8, 1.0, 1.0), {path}, {69.999, 70.001}, true);
  EXPECT_EQ(tally.exceedances(1, 1)[0], 1U);
  EXPECT_EQ(tally.exceedances(1, 1)[1], 0U);
}

/// A block thrown horizontally with a spin: above 1/2 m v^2 + rotation = E from the time at which (g t)^2 is the rest.
TEST(CountRotation, LengthsInFreeFall) {
  const Surface surface(test::terrain(test::grid_of(12, 4, 4.0, 4.0), [](double, double) { return -1000.0; }));
  constexpr double kSpeed = 12.0, kSpin = 25.0, kStart = 3.0, kEnd = 46.0;  // the outer half cell has no terrain
  Motion motion;
  motion.position = {kStart, 6.5, 0.0};
  motion.velocity = {kSpeed, 0.0, 0.0};
  PatchIndex at = surface.patch_at(motion.position.x(), motion.position.y());
  Path path;
  path.end = fly(surface, motion, at, false, path) == FlightEnd::Landed ? End::Stopped : End::Left;
  path.spins = {{0, kSpin}};
  const double rotation = 0.1 * kSpin * kSpin;                            // [m^2/s^2]
  const std::vector<double> limits{100.0, 210.0, 300.0, 1500.0, 2000.0};  // of v^2 + rotation; 206.5 at the start
  std::vector<double> energies;
  for (const double limit : limits) energies.push_back(0.5 * limit);
  const Tally tally = tally_with(surface.grid(), {path}, energies, true);
  for (std::size_t i = 0; i < limits.size(); ++i) {
    const double fast = std::sqrt(std::max(0.0, limits[i] - rotation - kSpeed * kSpeed)) / kGravity;
    double length = 0.0;
    for (int column = 0; column < 12; ++column)
      if (tally.find(column, 1) != nullptr) length += length_above(tally, column, 1, i);
    EXPECT_NEAR(length, std::max(0.0, kEnd - kStart - kSpeed * fast), 2e-4) << limits[i];
  }
}

/// A path that spins counts as one without spin whose v^2 is larger by D^2 w^2 / 10 (of a flight, in the plan speed).
TEST(CountRotation, ASpinIsAHigherSpeed) {
  const auto flight = [](int column, float plan, float from, float to) {
    return Span{{column, 1}, 0.1F, 0.25F, 0.9F, 0.25F, 1.0F, 1.0F, 0.0F, plan, from, to, 1};
  };
  Path spinning = path_of({flight(1, 40, 3, -8), flight(2, 30, 5, -5), flight(3, 90, 1, -2)}, End::Stopped);
  spinning.spins = {{0, 10.0}, {1, 0.0}, {2, 30.0}};
  Path faster = path_of({flight(1, 50, 3, -8), flight(2, 30, 5, -5), flight(3, 180, 1, -2)}, End::Stopped);
  faster.spins = {{0, 0.0}};
  const std::vector<double> thresholds{10.0, 20.0, 26.0, 40.0, 57.0, 90.1, 91.0, 95.0};
  const Grid grid = test::grid_of(8, 8, 1.0, 1.0);
  const Tally one = tally_with(grid, {spinning}, thresholds, true),
              other = tally_with(grid, {faster}, thresholds, true),
              plain = tally_with(grid, {faster}, thresholds, false);
  int cells = 0;
  for (int column = 0; column < 8; ++column) {
    if (one.find(column, 1) == nullptr) continue;
    ++cells;
    for (std::size_t i = 0; i < thresholds.size(); ++i) {
      EXPECT_EQ(one.exceedances(column, 1)[i], plain.exceedances(column, 1)[i]) << column << ' ' << thresholds[i];
      EXPECT_EQ(weight_above(one, column, 1, i), weight_above(plain, column, 1, i)) << column << ' ' << thresholds[i];
      EXPECT_NEAR(length_above(one, column, 1, i), length_above(plain, column, 1, i), 2e-6) << column;
    }
    EXPECT_EQ(*other.hazard(column, 1), *plain.hazard(column, 1)) << "without spin both settings are the same";
  }
  EXPECT_EQ(cells, 4);
}

TEST(CountRotation, OfABlockThatBreaks) {  // from the break on the limit is that of the lighter rest
  Path path = path_of({stay(1, 1, 100, 1), stay(2, 1, 100, 1)}, End::Stopped);
  path.spins = {{0, 20.0}, {1, 40.0}};
  path.breaks = {{0, 1, body_of(500.0, 0.5)}};  // 25 kJ, and 0.25 * 0.1 * 0.25 * 1600 = 10 kJ of rotation
  const Tally tally = tally_with(test::grid_of(8, 8, 1.0, 1.0), {path}, {30.0, 40.0}, true);
  EXPECT_EQ(tally.exceedances(2, 1)[0], 1U);
  EXPECT_EQ(tally.exceedances(2, 1)[1], 0U);
  EXPECT_GT(length_above(tally, 2, 1, 0), 0.0);
  EXPECT_EQ(length_above(tally, 2, 1, 1), 0.0);
  EXPECT_GT(length_above(tally, 1, 1, 1), 0.0) << "70 kJ before";
}

Scenario counted(bool with_rotation) {
  Scenario s = test::rough_slope(6, 100);
  for (SourceFeature& f : s.features) f.frequency = 1.0;
  s.output.energy_thresholds = {5.0, 20.0, 60.0};
  s.output.count_rotation = with_rotation;
  return make_scenario(std::move(s));
}

/// Each path in a tally of its own: the largest energy with rotation in each cell, compared with the thresholds.
TEST(CountRotation, IsTheCountOfThePathsAboveEachThreshold) {
  const Scenario s = counted(true);
  Tally tally = tally_of(s);
  simulate(s, tally, {}, 2);
  const Grid& grid = s.surface.grid();
  const std::size_t levels = s.output.energy_thresholds.size();
  std::vector<std::uint32_t> expected(grid.cells() * levels), translational(grid.cells() * levels);
  test::for_each_path(s, [&](const Release& release, const Path& path) {
    Tally own(grid, {}, {});
    own.keep_energy_total();
    VisitBatch batch(grid);
    batch.keep_energy_total();
    batch.add(path, release.body, 0, nullptr);
    own.add(batch);
    for (int row = 0; row < grid.rows; ++row)
      for (int column = 0; column < grid.columns; ++column) {
        if (own.find(column, row) == nullptr) continue;
        const auto cell = static_cast<std::size_t>(row * grid.columns + column) * levels;
        for (std::size_t i = 0; i < levels; ++i) {
          expected[cell + i] += own.energy_total(column, row)->maximum > s.output.energy_thresholds[i];
          translational[cell + i] += own.find(column, row)->maximum[Quantity::Energy] > s.output.energy_thresholds[i];
        }
      }
  });
  EXPECT_NE(expected, translational) << "otherwise this test says nothing of the rotation";
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      if (tally.find(column, row) == nullptr) continue;
      std::int64_t passages = 0;
      for (const HazardCell::Bin& bin : tally.hazard(column, row)->bins()) passages += bin.weight;
      for (std::size_t i = 0; i < levels; ++i) {
        const std::uint32_t hits = expected[static_cast<std::size_t>(row * grid.columns + column) * levels + i];
        ASSERT_EQ(tally.exceedances(column, row)[i], hits) << column << ' ' << row << ' ' << i;
        const std::int64_t each = passages / tally.find(column, row)->passages;  // the blocks have one weight
        ASSERT_EQ(weight_above(tally, column, row, i), each * hits);
      }
    }
}

/// All but energies is the same with either setting: passages, speeds, heights, and the energies of energy.tif.
TEST(CountRotation, ChangesNothingElse) {
  const Scenario with = counted(true), without = counted(false);
  Tally one = tally_of(with), other = tally_of(without);
  simulate(with, one, {}, 1);
  simulate(without, other, {}, 1);
  ASSERT_EQ(one.touched_cells(), other.touched_cells());
  bool above = false;
  for (int row = 0; row < one.grid().rows; ++row)
    for (int column = 0; column < one.grid().columns; ++column) {
      const CellRecord *a = one.find(column, row), *b = other.find(column, row);
      ASSERT_EQ(a == nullptr, b == nullptr);
      if (a == nullptr) continue;
      ASSERT_EQ(a->maximum, b->maximum);
      ASSERT_EQ(a->sum, b->sum);
      ASSERT_NEAR(static_cast<double>(a->length), static_cast<double>(b->length),
                  1e-5 * static_cast<double>(b->length));
      for (std::size_t i = 0; i < 3; ++i) {
        ASSERT_GE(one.exceedances(column, row)[i], other.exceedances(column, row)[i]);
        ASSERT_GE(length_above(one, column, row, i), length_above(other, column, row, i) - 1e-3);
        above = above || one.exceedances(column, row)[i] > other.exceedances(column, row)[i];
      }
      for (std::size_t i = 3; i < 3 + with.output.height_thresholds.size(); ++i)
        ASSERT_EQ(one.exceedances(column, row)[i], other.exceedances(column, row)[i]) << "a height";
    }
  EXPECT_TRUE(above);
}

/// Paths without spin: the saved bytes are those of a run that keeps the energy with rotation but does not count it.
TEST(CountRotation, WithoutSpinTheSameBytes) {
  const Scenario s = counted(false);
  Tally counting = tally_of(s), keeping = tally_of(s);
  counting.count_rotation();
  keeping.keep_energy_total();
  VisitBatch one(s.surface.grid(), {s.output.energy_thresholds, kAnyHeight, true}),
      other(s.surface.grid(), {s.output.energy_thresholds});
  other.keep_energy_total();
  std::uint64_t stratum = 0;
  test::for_each_path(s, [&](const Release& release, Path path) {
    for (SpinFrom& spin : path.spins) spin.spin = 0.0;
    for (VisitBatch* batch : {&one, &other}) {
      batch->set_annual_share({1000, stratum, 1});
      batch->add(path, release.body, release.source, nullptr);
    }
    ++stratum;
  });
  counting.add(one);
  keeping.add(other);
  for (std::size_t i = 0; i < counting.regions(); ++i) {
    ByteWriter a, b;
    counting.save(i, a);
    keeping.save(i, b);
    ASSERT_TRUE(std::ranges::equal(a.bytes(), b.bytes())) << i;
  }
}

TEST(CountRotation, TheSameForAnyThreads) {
  const Scenario s = counted(true);
  Tally one = tally_of(s), three = tally_of(s);
  simulate(s, one, {}, 1);
  simulate(s, three, {}, 3);
  test::expect_same_records(one, three);
  for (int row = 0; row < one.grid().rows; ++row)
    for (int column = 0; column < one.grid().columns; ++column)
      if (one.find(column, row) != nullptr) ASSERT_EQ(*one.hazard(column, row), *three.hazard(column, row));
}

}  // namespace
}  // namespace talus
