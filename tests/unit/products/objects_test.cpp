#include "talus/products/objects.hpp"

#include <gtest/gtest.h>

#include "support/scenarios.hpp"
#include "talus/simulate/simulate.hpp"

namespace talus {
namespace {

using test::three_sources;

HazardObject house(double west, double south, double east, double north) {
  return {{{{{west, south}, {east, south}, {east, north}, {west, north}, {west, south}}}}, {}};
}

HazardObject road(HazardObject::Ring line) {
  return {{}, {std::move(line)}};
}

double per_year(const WeightScale& scale, const ObjectHits& hits) {
  double sum = 0.0;
  for (const HazardCell::Bin& bin : hits.largest.bins()) sum += static_cast<double>(bin.weight) * scale.unit;
  return sum;
}

/// Blocks of radius 0.5 m fall straight down x = 21 m (0.5 a year) and x = 41 m (0.02 and 0.001 a year).
TEST(Objects, AreHitWithinTheRadiusOfTheBlock) {
  const Scenario s = three_sources();
  const AnnualWeights weights = AnnualWeights::of(s).value();
  const std::vector<HazardObject> objects{house(18.0, 20.0, 20.6, 24.0),  // 0.4 m beside the first line
                                          house(18.0, 20.0, 20.4, 24.0),  // 0.6 m beside it
                                          road({{10.0, 30.0}, {60.0, 30.0}}), road({{41.4, 50.0}, {41.4, 20.0}}),
                                          house(40.0, 63.0, 42.0, 66.0)};  // above the third source
  const auto hits = replay_objects(s, weights, objects, {}, 2);
  const WeightScale& scale = weights.scale();
  EXPECT_NEAR(per_year(scale, hits[0]), 0.5, 1e-9);
  EXPECT_EQ(per_year(scale, hits[1]), 0.0);
  EXPECT_NEAR(per_year(scale, hits[2]), 0.521, 1e-9);
  EXPECT_NEAR(per_year(scale, hits[3]), 0.021, 1e-9);
  EXPECT_NEAR(per_year(scale, hits[4]), 0.02, 1e-9);
  EXPECT_EQ(hits[2].trajectories, 90U);
  for (std::size_t feature = 0; feature < 3; ++feature)
    EXPECT_NEAR(static_cast<double>(hits[2].by_feature.at(feature)) * scale.unit, s.features[feature].frequency, 1e-9);
  EXPECT_FALSE(hits[3].by_feature.contains(0));
}

/// A block that falls through the yard of a house, 1 m from the walls, is no hit: the hole of the polygon is not the
/// house.
TEST(Objects, AHoleIsNotThere) {
  const Scenario s = three_sources();
  const AnnualWeights weights = AnnualWeights::of(s).value();
  HazardObject yard = house(36.0, 40.0, 46.0, 80.0);
  yard.polygons[0].push_back({{39.5, 50.0}, {42.5, 50.0}, {42.5, 79.0}, {39.5, 79.0}, {39.5, 50.0}});
  const auto all = replay_objects(s, weights, std::vector{yard}, {}, 1);
  EXPECT_NEAR(per_year(weights.scale(), all[0]), 0.021, 1e-9) << "they leave the yard at its southern end";
  yard.polygons[0][0] = {{36.0, -40.0}, {46.0, -40.0}, {46.0, 80.0}, {36.0, 80.0}, {36.0, -40.0}};
  yard.polygons[0][1] = {{39.5, -30.0}, {42.5, -30.0}, {42.5, 79.0}, {39.5, 79.0}, {39.5, -30.0}};
  EXPECT_EQ(per_year(weights.scale(), replay_objects(s, weights, std::vector{yard}, {}, 1)[0]), 0.0);
}

/// The number of blocks that cross a cell lies between two numbers of hits: of a house inside the cell, farther than a
/// radius from its sides, and of a house that fills it.
TEST(Objects, AgreeWithTheCells) {
  Scenario s = test::rough_slope(6, 60);
  for (SourceFeature& f : s.features) f.frequency = 1.0;
  s = make_scenario(std::move(s));
  const AnnualWeights weights = AnnualWeights::of(s).value();
  Tally tally(s.surface.grid(), s.output.energy_thresholds, s.output.height_thresholds);
  tally.keep_hazard(weights);
  simulate(s, tally, {}, 1);
  for (const int column : {20, 45}) {
    int row = 0;
    for (int r = 0; r < 70; ++r)
      if (tally.find(column, r) != nullptr &&
          (tally.find(column, row) == nullptr || tally.find(column, r)->passages > tally.find(column, row)->passages))
        row = r;
    const std::vector<HazardObject> objects{
        house(2.0 * column + 0.6, 2.0 * row + 0.6, 2.0 * column + 1.4, 2.0 * row + 1.4),
        house(2.0 * column, 2.0 * row, 2.0 * column + 2.0, 2.0 * row + 2.0)};
    const auto one = replay_objects(s, weights, objects, {}, 1), two = replay_objects(s, weights, objects, {}, 2);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(one[i].largest, two[i].largest);
      EXPECT_EQ(one[i].entry, two[i].entry);
    }
    EXPECT_LE(one[0].trajectories, tally.find(column, row)->passages);
    EXPECT_GE(one[1].trajectories, tally.find(column, row)->passages);
    EXPECT_GT(one[0].trajectories, 0U);
  }
}

TEST(Objects, CanBeEnded) {
  const Scenario s = three_sources();
  const std::vector<HazardObject> objects{house(18.0, 20.0, 20.6, 24.0)};
  EXPECT_TRUE(replay_objects(
                  s, *AnnualWeights::of(s), objects, [](double) { return false; }, 2)
                  .empty());
}

}  // namespace
}  // namespace talus
