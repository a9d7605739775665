#include "talus/simulate/tally/hazard_tally.hpp"

#include <gtest/gtest.h>

#include "support/scenarios.hpp"
#include "talus/simulate/simulate.hpp"

namespace talus {
namespace {

using test::path_of;
using test::stay;

TEST(EnergyBins, EachValueLiesInItsBin) {
  const EnergyBins bins({30.0, 32.0, 300.0});  // 32 is also an edge of the doublings
  test::Numbers numbers(1);
  for (int i = 0; i < 20000; ++i) {
    const auto energy = static_cast<float>(std::exp(numbers.uniform(-4.0, 20.0)));
    const int bin = bins.of(energy);
    EXPECT_LE(bins.edge(bin), energy);
    EXPECT_GE(bins.edge(bin + 1), energy);
    EXPECT_LE(bins.edge(bin + 1) / bins.edge(bin), 1.125);
  }
  EXPECT_EQ(bins.of(0.0F), 0);
  EXPECT_EQ(bins.of(1e30F), bins.of(2e30F));
  EXPECT_LT(bins.of(1e30F), bins.count());
}

TEST(EnergyBins, WhatExceedsAThresholdIsWholeBins) {
  const EnergyBins bins({30.0, 32.0, 300.0});
  for (std::size_t i = 0; i < 3; ++i) {
    const auto t = static_cast<float>(bins.thresholds()[i]);
    EXPECT_LT(bins.of(t), bins.above(i)) << "the threshold itself does not exceed it";
    EXPECT_LT(bins.of(std::nextafter(t, 0.0F)), bins.above(i));
    EXPECT_GE(bins.of(std::nextafter(t, 1e9F)), bins.above(i));
    EXPECT_EQ(bins.edge(bins.above(i)), bins.thresholds()[i]);
  }
}

/// A run with two features of different frequencies; the same cells are reached from both.
Scenario two_features() {
  Scenario s = test::rough_slope(6, 150);  // 150 blocks: strata of 128 and of 22
  s.features.assign(2, s.features[0]);
  s.features[0].frequency = 0.7;
  s.features[1].frequency = 0.01;
  for (std::size_t i = 0; i < s.sources.size(); ++i) s.sources[i].feature = i % 2;
  return make_scenario(std::move(s));
}

Tally tally_of(const Scenario& s, int threads) {
  Tally tally(s.surface.grid(), s.output.energy_thresholds, s.output.height_thresholds);
  tally.keep_hazard(*AnnualWeights::of(s));
  simulate(s, tally, {}, threads);
  return tally;
}

TEST(HazardTally, SumsAreThoseOfTheCounts) {
  const Scenario s = two_features();
  const Tally tally = tally_of(s, 2);
  const HazardRules& rules = tally.hazard_rules();
  const std::int64_t often = AnnualWeights::of(s)->weight(s, 0, 0), seldom = AnnualWeights::of(s)->weight(s, 1, 0);
  for (int row = 0; row < tally.grid().rows; ++row)
    for (int column = 0; column < tally.grid().columns; ++column) {
      const CellRecord* record = tally.find(column, row);
      const HazardCell* cell = tally.hazard(column, row);
      ASSERT_EQ(record == nullptr, cell == nullptr);
      if (cell == nullptr) continue;
      std::int64_t sum = 0;
      for (const HazardCell::Bin& bin : cell->bins()) sum += bin.weight;
      const std::int64_t from_often = (sum - seldom * record->passages) / (often - seldom);  // k1 + k2 = passages
      EXPECT_EQ(from_often * often + (record->passages - from_often) * seldom, sum);
      EXPECT_GE(from_often, 0);
      EXPECT_LE(from_often, record->passages);
      EXPECT_EQ(cell->overlaps().size(), rules.levels());
    }
}

TEST(HazardTally, ThreadsAndFrequenciesChangeNoBit) {
  const Scenario s = two_features();
  const Tally one = tally_of(s, 1), two = tally_of(s, 2), seven = tally_of(s, 7);
  for (int row = 0; row < one.grid().rows; ++row)
    for (int column = 0; column < one.grid().columns; ++column) {
      const HazardCell* cell = one.hazard(column, row);
      if (cell == nullptr) continue;
      ASSERT_EQ(*cell, *two.hazard(column, row)) << column << ' ' << row;
      ASSERT_EQ(*cell, *seven.hazard(column, row)) << column << ' ' << row;
    }
  Tally plain(s.surface.grid(), s.output.energy_thresholds, s.output.height_thresholds);
  simulate(s, plain, {}, 2);
  test::expect_same_records(one, plain);
}

TEST(HazardTally, OneTrajectoryCountsOnceWithItsLargestEnergy) {  // 1000 kg: 2, 18 and 50 kJ
  Scenario s = test::scenario_on(test::terrain(test::grid_of(6, 4, 1.0, 1.0), [](double, double) { return 0.0; }));
  s.sources.assign(1, {0, 1.5, 1.5, false});
  s.trajectories = 4;
  s.features[0].frequency = 1.0;  // each trajectory 0.25 per year
  s.output.energy_thresholds = {10.0, 30.0};
  const AnnualWeights weights = AnnualWeights::of(s).value();
  Tally tally(s.surface.grid(), s.output.energy_thresholds, s.output.height_thresholds);
  tally.keep_hazard(weights);
  VisitBatch batch(tally.grid());
  for (std::uint32_t block = 0; block < 3; ++block) {
    const float speed_squared = block == 0 ? 4.0F : block == 1 ? 36.0F : 100.0F;
    batch.set_annual_share({weights.weight(s, 0, block), 0, 4});
    batch.add(path_of({stay(1, 1, 1, 1), stay(2, 1, 1, 1), stay(1, 1, speed_squared, 1)}, End::Left), 1000.0, 0,
              nullptr);
  }
  tally.add(batch);
  const HazardCell& cell = *tally.hazard(1, 1);
  const HazardRules& rules = tally.hazard_rules();
  std::vector<double> over(3);
  for (std::size_t i = 0; i < cell.bins().size(); ++i)
    for (std::size_t level = 0; level < 3; ++level)
      if (level == 0 || cell.first() + static_cast<int>(i) >= rules.bins.above(level - 1))
        over[level] += static_cast<double>(cell.bins()[i].weight) * rules.scale.unit;
  EXPECT_NEAR(over[0], 0.75, 1e-12);
  EXPECT_NEAR(over[1], 0.50, 1e-12);
  EXPECT_NEAR(over[2], 0.25, 1e-12);
  // By hand, w = 1/4: ((k w)^2 - k w^2) / 3 of k = 3, 2, 1 are 1/8, 1/24, 0. Units and squares are powers of two.
  const std::vector<double> expected{6.0 / 16.0 / 3.0, 2.0 / 16.0 / 3.0, 0.0};
  for (std::size_t level = 0; level < 3; ++level)
    EXPECT_NEAR(static_cast<double>(cell.overlaps()[level]) * rules.scale.square_unit, expected[level], 1e-9);
}

TEST(StratumSums, AnEnergyAtTheThresholdDoesNotExceedIt) {
  Scenario s = test::scenario_on(test::terrain(test::grid_of(6, 4, 1.0, 1.0), [](double, double) { return 0.0; }));
  s.sources.assign(1, {0, 1.5, 1.5, false});
  s.trajectories = 4;
  s.features[0].frequency = 1.0;
  const AnnualWeights weights = AnnualWeights::of(s).value();
  Tally tally(s.surface.grid(), {18.0, 30.0}, s.output.height_thresholds);
  tally.keep_hazard(weights);
  StratumSums sums(tally.hazard_rules());
  ScratchVector<std::int64_t> overlaps;
  for (int hit = 0; hit < 2; ++hit) sums.add({weights.weight(s, 0, 0), 0, 4}, 18.0F, overlaps);
  sums.finish(overlaps);
  EXPECT_GT(overlaps[0], 0) << "two of four have hit";
  EXPECT_EQ(overlaps[1], 0) << "with exactly 18 kJ";
}

TEST(HazardCell, MergingPartsGivesTheWhole) {
  const Scenario s = two_features();
  const Tally whole = tally_of(s, 1);
  HazardCell twice;
  const HazardCell& cell = *whole.hazard(s.surface.grid().column_of(30.0), s.surface.grid().row_of(33.0));
  twice.merge(cell);
  EXPECT_EQ(twice, cell);
  twice.merge(cell);
  for (std::size_t i = 0; i < cell.bins().size(); ++i) EXPECT_EQ(twice.bins()[i].weight, 2 * cell.bins()[i].weight);
}

}  // namespace
}  // namespace talus
