#include "talus/products/object_width.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/maps.hpp"
#include "support/scenarios.hpp"
#include "talus/products/hazard_maps.hpp"

namespace talus {
namespace {

TEST(Disc, HasTheAreaOfADisc) {
  for (const double cell : {1.0, 2.0, 5.0}) {
    double sum = 0.0, second = 0.0;
    for (const DiscCell& part : disc(20.0, cell, cell)) {
      sum += part.share;
      second += part.share * cell * cell * (part.column * part.column + part.row * part.row);
    }
    EXPECT_NEAR(sum, 1.0, 1e-12);
    EXPECT_NEAR(second, 50.0, cell * cell / 3.0) << "R^2 / 2 is the mean square of the distance; a cell has its own";
  }
  EXPECT_EQ(disc(3.0, 5.0, 5.0).size(), 1U);
  EXPECT_EQ(disc(1e-9, 5.0, 5.0).size(), 1U);
}

/// An object of 10 m in a field of 0.01 blocks per year and metre, with blocks of 1 and 3 m, half each: 0.12 hits.
TEST(HitsOfObject, ByHand) {
  const WeightScale scale{1.0, 1.0, 1.0, 1, 1, true, 2.0};
  const Bounded hits = hits_of_object({0.01, 0.02, 0.01}, scale, 10.0, 10.0);
  EXPECT_NEAR(hits.value, 0.12, 1e-12);
  EXPECT_EQ(hits.low, 0.0) << "less than one block";
  const double per_block = 1.0808 * 12.0 / 10.0;  // nothing passes: 3.69 blocks of the largest diameter
  EXPECT_NEAR(hits_of_object({}, scale, 10.0, 10.0).high, 3.6889 * per_block, 2e-3);
}

/// Straight paths at random through a region: the bounds of a disc in it hold the true number of hits.
TEST(HitsOfObject, BoundsCoverStraightPathsAtRandom) {
  test::Numbers numbers(5);
  constexpr double kRegion = 60.0, kWidth = 10.0, kDiameter = 2.0;
  const WeightScale scale{0x1p-20, 0x1p-40, 1.0, 1 << 20, 1, true, kDiameter};  // each block: one event per year
  for (const double mean : {1.0, 4.0, 20.0, 100.0}) {                           // blocks through the disc
    constexpr int kDraws = 4000;
    const int blocks = 2000;
    const double chance = mean * kRegion / kWidth / blocks;  // of a block to be released
    int missed = 0;
    for (int draw = 0; draw < kDraws; ++draw) {
      double length = 0.0;
      for (int block = 0; block < blocks; ++block) {
        if (!(numbers.uniform(0, 1) < chance)) continue;
        const double beside = numbers.uniform(-0.5 * kRegion, 0.5 * kRegion);
        length += 2.0 * std::sqrt(std::max(0.0, 0.25 * kWidth * kWidth - beside * beside));
      }
      const double density = length / (0.25 * kPi * kWidth * kWidth);
      const Bounded hits = hits_of_object({density, density * kDiameter, density}, scale, kWidth, kWidth);
      const double truth = mean / kWidth * (kWidth + kDiameter);
      missed += hits.low > truth || hits.high < truth ? 1 : 0;
    }
    EXPECT_LE(missed / double{kDraws}, 0.05 + 5.0 * std::sqrt(0.05 * 0.95 / kDraws)) << mean;
  }
}

/// Small and large blocks that cross a disc, Poisson numbers of both: the upper bound is too low in 2.5 % of the draws
/// at most, however narrow the disc is beside the large blocks. f = sum of n (W + D) / W in closed form.
TEST(HitsOfObject, UpperBoundHoldsForBlocksOfTwoSizes) {
  test::Numbers numbers(8);
  constexpr double kSmall = 0.3, kLarge = 5.0;
  const auto poisson = [&](double mean) {
    int n = 0;
    for (double p = numbers.uniform(0, 1); p > std::exp(-mean); p *= numbers.uniform(0, 1)) ++n;
    return n;
  };
  const WeightScale scale{0x1p-20, 0x1p-40, 1.0, 1 << 20, 1, true, kLarge};
  for (const double width : {1.0, 2.0, 5.0, 10.0}) {
    constexpr int kDraws = 4000;
    const double truth = 2.0 * (width + kSmall) / width + 2.0 * (width + kLarge) / width;
    int missed = 0;
    for (int draw = 0; draw < kDraws; ++draw) {
      PassageDensity density;
      for (const double diameter : {kSmall, kLarge})
        for (int block = poisson(2.0); block > 0; --block) {
          const double beside = numbers.uniform(-1.0, 1.0);
          const double length = width * std::sqrt(1.0 - beside * beside) / (0.25 * kPi * width * width);
          density.length += length;
          density.by_diameter += length * diameter;
          density.squares += length;
        }
      missed += hits_of_object(density, scale, width, width).high < truth ? 1 : 0;
    }
    EXPECT_LE(missed / double{kDraws}, 0.025 + 5.0 * std::sqrt(0.025 * 0.975 / kDraws)) << width;
  }
}

/// A hit never lowers the upper bound.
TEST(HitsOfObject, ASmallBlockThatHitsDoesNotReassure) {
  const WeightScale scale{1.0, 1.0, 1.0, 1, 1, true, 5.0};
  const double none = hits_of_object({}, scale, 1.0, 1.0).high;
  EXPECT_GT(hits_of_object({1.0, 0.3, 1.0}, scale, 1.0, 1.0).high, none);
}

/// A block of 2.5e-6 events per year beside one of 250, which passes a cell of 2 m: w L and w L D to 0.05 %, however
/// many rounds there may be.
TEST(DensitiesOf, RareBlocksAreRoundedAsLittleInRoundsAsInOne) {
  Scenario s = test::scenario_on(test::terrain(test::grid_of(8, 8, 2.0, 2.0), [](double, double) { return 0.0; }));
  s.features.assign(2, SourceFeature{});
  s.features[0].frequency = 1000.0;
  s.features[1].frequency = 1e-5;
  s.sources = {{0, 3.0, 3.0, false}, {1, 9.0, 9.0, false}};
  s.trajectories = 4;
  for (const std::uint32_t rounds : {1U, 2U, 100U, 10'000U}) {
    const AnnualWeights weights = AnnualWeights::of(s, rounds).value();
    const HazardRules rules{EnergyBins({30.0}), weights.scale()};
    HazardCell cell;
    for (const float length : {0.3F, 1.1F, 2.0F})
      cell.add_lengths(rules, std::vector<float>{length, 0.0F}, {weights.weight(s, 1, 0), 0, 4}, 0.5);
    const PassageDensity density = densities_of(cell, rules.scale, 4.0).front();
    EXPECT_NEAR(density.length / (2.5e-6 * 3.4 / 4.0), 1.0, 5e-4) << rounds;
    EXPECT_NEAR(density.by_diameter / (2.5e-6 * 1.7 / 4.0), 1.0, 5e-4) << rounds;
  }
}

/// The sum of all rounds fits: each adds a block that is all events of the year and stays 1 km in the cell.
TEST(DensitiesOf, ManyRoundsOfLongWaysFit) {
  Scenario s = test::scenario_on(test::terrain(test::grid_of(8, 8, 100.0, 100.0), [](double, double) { return 0.0; }));
  s.sources.assign(1, {0, 150.0, 150.0, false});
  s.features[0].frequency = 3.0;
  s.trajectories = 1;
  const AnnualWeights weights = AnnualWeights::of(s, 10'000).value();
  const HazardRules rules{EnergyBins({30.0}), weights.scale()};
  HazardCell cell, all;
  cell.add_lengths(rules, std::vector<float>{1000.0F, 0.0F}, {weights.weight(s, 0, 0), 0, 1}, 50.0);
  for (int round = 0; round < 10'000; ++round) all.merge(cell);
  const PassageDensity density = densities_of(all, rules.scale, 1e4).front();
  EXPECT_NEAR(density.length / (10'000 * 3.0 * 1000.0 / 1e4), 1.0, 1e-9);
  EXPECT_NEAR(density.by_diameter / (10'000 * 3.0 * 50.0 * 1000.0 / 1e4), 1.0, 1e-9);
}

/// Over all places across a flow of 0.5 blocks per year, the hits add up to 0.5 (W + D), whatever the cell.
TEST(HitsOfObject, AddUpOverAllPlacesAcrossAFlow) {
  const double unit = 0x1p-40;
  for (const double cell : {1.0, 2.5, 5.0}) {
    const int side = static_cast<int>(std::lround(100.0 / cell));
    const WeightScale scale{unit, 0x1p-60, 1.0, static_cast<std::int64_t>(0.1 / unit), 10, true, 2.0};
    const HazardRules rules{EnergyBins({30.0, 300.0}), scale};
    HazardSurvey survey(test::grid_of(side, side, cell, cell), rules, {}, {10.0, 0.0});
    HazardCell passed;
    for (int block = 0; block < 5; ++block)
      passed.add_lengths(rules, std::vector<float>{static_cast<float>(cell), static_cast<float>(cell), 0.0F},
                         {scale.largest, 0, 10}, 2.0);
    const std::vector<HazardAt> cells{{side / 2, passed, false}};
    for (int row = 0; row < side; ++row)
      survey.set_row(row, std::vector<bool>(static_cast<std::size_t>(side), true), cells);
    survey.finish(2);
    const Map map = make_hazard_maps(survey).front();
    ASSERT_EQ(map.name, "annual_frequency");
    std::vector<double> values(3 * static_cast<std::size_t>(side));
    test::fill_row(map, side / 2, values);
    double sum = 0.0;
    for (int column = 0; column < side; ++column) sum += values[static_cast<std::size_t>(column)] * cell;
    EXPECT_NEAR(sum, 0.5 * 12.0, 1e-4) << cell;
  }
}

}  // namespace
}  // namespace talus
