#include "talus/simulate/scenario/frequency.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/scenarios.hpp"
#include "talus/base/error.hpp"
#include "talus/simulate/plan/plan.hpp"
#include "talus/simulate/scenario/block_class.hpp"

namespace talus {
namespace {

/// A plane of 20 x 20 cells of 2 m that rises to the east with a slope [degrees]; cells of sources by feature.
Scenario plane(double degrees, std::vector<std::uint32_t> features) {
  Scenario s = test::scenario_on(
      test::terrain(test::grid_of(20, 20, 2.0, 2.0), [&](double x, double) { return x * std::tan(radians(degrees)); }));
  s.features.assign(1 + *std::max_element(features.begin(), features.end()), SourceFeature{});
  for (std::size_t i = 0; i < features.size(); ++i)
    s.sources.push_back({features[i], 5.0 + 2.0 * static_cast<double>(i), 7.0, false});
  s.trajectories = 10;
  return s;
}

/// Events per year of a source cell: the sum over its trajectories.
double per_year(const Scenario& s, std::uint32_t source) {
  const AnnualWeights weights = AnnualWeights::of(s).value();
  std::int64_t sum = 0;
  for (std::uint32_t block = 0; block < s.trajectories; ++block) sum += weights.weight(s, source, block);
  return static_cast<double>(sum) * weights.scale().unit;
}

void refused(const Scenario& s, const std::string& words) {
  try {
    AnnualWeights::of(s);
    FAIL() << "was taken: " << words;
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr(words));
  }
}

TEST(AnnualWeights, NoFrequencyNoWeights) {
  EXPECT_FALSE(AnnualWeights::of(plane(30.0, {0, 0})).has_value());
  Scenario zeros = plane(30.0, {0, 0});
  zeros.features[0].frequency = 0.0;  // an attribute that nobody filled in
  EXPECT_FALSE(AnnualWeights::of(zeros).has_value());
}

TEST(AnnualWeights, NumbersTooSmallToReckonWithAreRefused) {
  Scenario s = plane(30.0, {0, 0});
  s.frequency.total = 1e-160;  // its square is 0: the file of the hazard could not be read
  refused(s, "1e-100 at least");
  s.frequency.total = 5e-324;  // that of a cell is 0
  refused(s, "1e-100 at least");
  s.frequency.total = 1e-20;
  EXPECT_NEAR(per_year(s, 0), 0.5e-20, 1e-30);
  s.frequency.total = 1.0;
  s.frequency.class_shares = true;
  s.blocks.classes = {{{1.0, 1.0}, 1.0, 0.1}, {{3.0, 3.0}, 1e-160, 0.9}};
  refused(s,
          "the class of 3 m has the weight 1e-160, far too small for its 90 % of the events: give it 0.0009 or more");
}

TEST(AnnualWeights, AFeaturesFrequencyIsDividedOverItsCells) {
  Scenario s = plane(30.0, {0, 0, 0, 1});
  s.features[0].frequency = 0.3;
  s.features[1].frequency = 2.0;
  for (const std::uint32_t source : {0U, 1U, 2U}) EXPECT_NEAR(per_year(s, source), 0.1, 1e-12);
  EXPECT_NEAR(per_year(s, 3), 2.0, 1e-12);
  const WeightScale scale = AnnualWeights::of(s)->scale();
  EXPECT_NEAR(scale.total, 2.3, 1e-12);
  EXPECT_FALSE(scale.equal);
  EXPECT_NEAR(scale.largest_weight(), 0.2, 1e-12);
  EXPECT_LT(scale.total / scale.unit, 0x1p62);  // the sum over all trajectories fits
  EXPECT_LT(1e9 * scale.unit, 1e-9);            // and 1e-9 events per year are very many units
}

/// The weights of all blocks of all rounds stay below 2^62 units, of which one round is 2^62 / 2^ceil(log2(rounds)).
TEST(AnnualWeights, RoundsTakeTheBitsThatTheyNeed) {
  Scenario s = plane(30.0, {0, 0, 0, 1});
  s.features[0].frequency = 0.3;
  s.features[1].frequency = 2.0;
  const WeightScale one = AnnualWeights::of(s)->scale();
  EXPECT_EQ(one.room, 1.0);
  for (const auto& [rounds, room] :
       {std::pair{1U, 1.0}, {2U, 2.0}, {3U, 4.0}, {4U, 4.0}, {100U, 128.0}, {10'000U, 16'384.0}}) {
    const WeightScale scale = AnnualWeights::of(s, rounds)->scale();
    EXPECT_EQ(scale.room, room);
    EXPECT_EQ(scale.unit, room * one.unit);
    EXPECT_EQ(scale.square_unit, room * one.square_unit);
    EXPECT_LT(rounds * (scale.total / scale.unit), 0x1p62);
    EXPECT_NEAR(scale.largest_weight(), 0.2, 1e-9);
  }
  s.features[0].frequency = 2e-11;  // of 30 blocks: 3e-13 of all events each, which 10 000 rounds cannot hold to 0.05 %
  EXPECT_TRUE(AnnualWeights::of(s, 100).has_value());
  EXPECT_THROW(AnnualWeights::of(s, 10'000), InputError);
}

/// Walls of 45 and of 80 degrees of one true area, 4 * 4 m^2 * cos: the steeper one has fewer cells in plan.
TEST(AnnualWeights, EqualTrueAreasHaveEqualFrequencies) {
  const double ratio = std::cos(radians(45.0)) / std::cos(radians(80.0));  // of the true areas of one cell
  for (const double degrees : {45.0, 80.0}) {
    Scenario s = plane(degrees, {0, 0});
    s.frequency.per_area = 1e-3;
    s.frequency.by_true_area = true;
    const double area = 4.0 / std::cos(radians(degrees));
    EXPECT_NEAR(per_year(s, 0), 1e-3 * area, 1e-3 * area * 1e-4);  // heights are floats
    s.frequency.by_true_area = false;
    EXPECT_NEAR(per_year(s, 0), 4e-3, 1e-12);
  }
  EXPECT_NEAR(ratio, 4.07, 0.01);
}

/// Two walls of one true area: 57 cells at 45 degrees are 57 x 4 / cos 45 = 322.4 m2, 14 at 80 degrees 322.5 m2.
TEST(AnnualWeights, TwoWallsOfOneTrueAreaFallEquallyOften) {
  const auto wall = [](double degrees, int cells) {
    Scenario s = plane(degrees, {0});
    s.sources.clear();
    for (int i = 0; i < cells; ++i) s.sources.push_back({0, 5.0 + 2.0 * (i % 15), 7.0 + 2.0 * (i / 15), false});
    s.frequency.per_area = 1e-3;
    s.frequency.by_true_area = true;
    return AnnualWeights::of(s)->scale().total;
  };
  EXPECT_NEAR(wall(45.0, 57), 0.3224, 2e-4);
  EXPECT_NEAR(wall(80.0, 14), wall(45.0, 57), 2e-4);
}

/// N(>= V) = A V^-b over classes that are ranges of diameters, by hand: volumes pi/6 D^3 of 1 to 2 m and 2 to 4 m.
TEST(AnnualWeights, PowerLawOverClasses) {
  Scenario s = plane(30.0, {0, 0});
  s.blocks.classes = {{{1.0, 2.0}, 3.0, kNotGiven}, {{2.0, 4.0}, 1.0, kNotGiven}};
  s.frequency.scale = 0.2;
  s.frequency.exponent = 1.0 / 3.0;  // V^(-1/3) is (pi/6)^(-1/3) / D
  const double c = 0.2 * std::pow(kPi / 6.0, -1.0 / 3.0);
  EXPECT_NEAR(AnnualWeights::of(s)->scale().total, c * (1.0 - 0.25), 1e-12);
  const AnnualWeights weights = AnnualWeights::of(s).value();
  std::int64_t small = 0, large = 0;  // of one block of each class: events of the class / (blocks x share drawn)
  for (std::uint32_t block = 0; block < s.trajectories; ++block)
    (class_of_block(s, 0, block) == 0 ? small : large) = weights.weight(s, 0, block);
  const double unit = weights.scale().unit, blocks = 2.0 * s.trajectories;
  ASSERT_GT(std::min(small, large), 0);
  EXPECT_NEAR(static_cast<double>(small) * unit, c * 0.5 / (blocks * 0.75), 1e-12);
  EXPECT_NEAR(static_cast<double>(large) * unit, c * 0.25 / (blocks * 0.25), 1e-12);
  s.blocks.classes[1].diameter = {1.5, 4.0};
  refused(s, "classes of blocks that overlap");
  s.blocks.classes[1].diameter = {3.0, 4.0};  // of 2 to 3 m: c (1/2 - 1/3) = 0.0414
  refused(s, "a gap between classes of blocks, from 2 to 3 m, must lie side by side: 0.0414 events per year");
  s.blocks.classes[1].diameter = {3.0, 3.0};
  refused(s, "blocks of one diameter");
}

TEST(AnnualWeights, AFieldOfZerosCountsAsNotGiven) {
  Scenario s = plane(30.0, {0, 0});
  s.features[0].frequency = 0.0;
  s.frequency.per_area = 0.01;
  EXPECT_NEAR(AnnualWeights::of(s)->scale().total, 2 * 4.0 * 0.01, 1e-12);
}

/// One feature over a 45 and an 80 degree face: with the switch the steep cells get more of its frequency.
TEST(AnnualWeights, TheSwitchDividesAFeatureByTrueArea) {
  Scenario s = plane(45.0, {0, 0});
  Raster<float> heights = s.surface.heights();
  for (int row = 0; row < 20; ++row)
    for (int column = 10; column < 20; ++column)
      heights.at(column, row) = static_cast<float>(18.0 + (column - 9) * 2.0 * std::tan(radians(80.0)));
  s.surface = Surface(heights);
  s.sources[1].x = 31.0;
  s.features[0].frequency = 1.0;
  EXPECT_NEAR(per_year(s, 0), 0.5, 1e-12);
  s.frequency.by_true_area = true;
  const double gentle = 1.0 / std::cos(radians(45.0)), steep = 1.0 / std::cos(radians(80.0));
  EXPECT_NEAR(per_year(s, 0), gentle / (gentle + steep), 1e-4);
  EXPECT_NEAR(per_year(s, 0) + per_year(s, 1), 1.0, 1e-12);
}

TEST(AnnualWeights, PowerLawOfVolume) {  // by hand: 0.1 (1^-0.5 - 100^-0.5) = 0.1 (1 - 0.1)
  Scenario s = plane(30.0, {0, 0, 0});
  s.blocks.classes.clear();
  s.blocks.power_law = {{1.0, 100.0}, 0.5};
  s.frequency.scale = 0.1;
  s.frequency.exponent = 0.5;
  for (const std::uint32_t source : {0U, 1U, 2U}) EXPECT_NEAR(per_year(s, source), 0.03, 1e-12);
  EXPECT_TRUE(AnnualWeights::of(s)->scale().equal);
  s.frequency.exponent = 0.6;
  refused(s, "must be the exponent of blocks.diameter, 0.5");
}

/// Classes drawn equally often that come 9 : 1; each block's weight follows from its diameter.
TEST(AnnualWeights, ClassesOfBlocks) {
  Scenario s = plane(30.0, {0, 0});
  s.blocks.classes = {{{0.5, 0.5}, 1.0, 0.9}, {{2.0, 2.0}, 1.0, 0.1}};
  const AnnualWeights weights = AnnualWeights::of(s).value();
  for (std::uint32_t block = 0; block < 10; ++block) {
    const double diameter = make_release(s, 1, block).body.diameter;
    const double expected =
        (diameter < 1.0 ? 0.9 : 0.1) / 2.0 / (10.0 * 0.5);  // over cells; over the blocks of a class
    EXPECT_NEAR(static_cast<double>(weights.weight(s, 1, block)) * weights.scale().unit, expected, 1e-12);
  }
  EXPECT_NEAR(weights.scale().total, 1.0, 1e-12);
}

/// 9 : 1 of 4 events per year in all: of both cells together, of two features with 3 and 1, of 8 m2 with 0.5 each.
TEST(AnnualWeights, SharesOfClasses) {
  const auto expect = [](const Scenario& s, double first, double second) {  // events per year of the two cells
    const AnnualWeights weights = AnnualWeights::of(s).value();
    EXPECT_NEAR(weights.scale().total, 4.0, 1e-12);
    for (std::uint32_t source : {0U, 1U})
      for (std::uint32_t block = 0; block < 10; ++block) {
        const double share = make_release(s, source, block).body.diameter < 1.0 ? 0.9 : 0.1;
        EXPECT_NEAR(static_cast<double>(weights.weight(s, source, block)) * weights.scale().unit,
                    (source == 0 ? first : second) * share / (10.0 * 0.5), 1e-12);
      }
  };
  Scenario s = plane(30.0, {0, 1});
  s.blocks.classes = {{{0.5, 0.5}, 1.0, 1.8}, {{2.0, 2.0}, 1.0, 0.2}};
  s.frequency.class_shares = true;
  EXPECT_FALSE(AnnualWeights::of(s).has_value());  // how often is not said
  Scenario total = s, by_feature = s, by_area = s;
  total.frequency.total = 4.0;
  expect(total, 2.0, 2.0);
  by_feature.features[0].frequency = 3.0, by_feature.features[1].frequency = 1.0;
  expect(by_feature, 3.0, 1.0);
  by_area.frequency.per_area = 0.5;  // of two cells of 4 m2
  expect(by_area, 2.0, 2.0);
}

/// Cells of 4 m2, one of which three features release: two times too often.
TEST(FrequencyWarnings, CellsOfSeveralFeatures) {
  Scenario s = plane(60.0, {0, 0, 1, 1, 2});
  s.blocks.classes = {{{0.1, 0.1}, 1.0}};  // so that the rock face hardly goes back
  s.frequency.per_area = 0.5;
  EXPECT_TRUE(frequency_warnings(s).empty());
  for (const std::size_t cell : {2U, 4U}) s.sources[cell].x = s.sources[0].x;
  const auto expect = [&](const std::string& words) {
    const std::vector<std::string> warnings = frequency_warnings(s);
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_THAT(warnings.front(), testing::StartsWith("sources overlap: 1 of 3 cells lie in more than one feature"));
    EXPECT_THAT(warnings.front(), testing::HasSubstr(words));
    EXPECT_TRUE(is_of_frequencies(warnings.front()));
  };
  expect("frequency.per_area counts 4 events per year more than once");  // 0.5 x 2 x 4
  s.frequency.by_true_area = true;
  expect("frequency.per_area counts 8 events per year more than once");  // an area of 4 / cos 60
  s.frequency = {};
  s.frequency.total = 1.0;
  expect("a larger share of the events");
  s.frequency = {};
  expect("release the blocks of each: join the features");
  for (SourceFeature& feature : s.features) feature.frequency = 0.1;
  expect("so that the events per year of each count there");
}

TEST(FrequencyWarnings, PointsThatAreThereTwice) {
  Scenario s = plane(60.0, {0, 0, 1, 1, 2});
  for (SourceCell& cell : s.sources) cell.point = true;
  for (std::size_t i = 0; i < s.features.size(); ++i) {
    s.features[i].id = static_cast<std::int64_t>(i + 7);
    s.features[i].name = std::to_string(i + 7);  // its number, as it has no name
  }
  EXPECT_TRUE(frequency_warnings(s).empty());
  for (const std::size_t cell : {2U, 4U}) s.sources[cell].x = s.sources[0].x;
  const auto expect = [&](const std::string& words) {
    const std::vector<std::string> warnings = frequency_warnings(s);
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_THAT(warnings.front(), testing::StartsWith("points of sources: " + words));
    EXPECT_TRUE(is_of_frequencies(warnings.front()));
  };
  expect("2 points have the place and the fields of another (FID 8, 9)");
  s.features[2].velocity.z() = 1.0;
  expect("1 point has the place and the fields of another (FID 8)");
  s.features[1].name = "cliff";
  EXPECT_TRUE(frequency_warnings(s).empty());
}

/// A polygon of 1 m2 whose cell has 4 m2, and one of two cells that is as large as these.
TEST(FrequencyWarnings, CellsOfAnotherAreaThanTheirPolygon) {
  Scenario s = plane(60.0, {0, 1, 1});
  s.blocks.classes = {{{0.1, 0.1}, 1.0}};
  s.features[0].drawn_area = 1.0, s.features[1].drawn_area = 8.0;
  s.frequency.total = 1.0;
  EXPECT_TRUE(frequency_warnings(s).empty());
  s.frequency = {};
  s.frequency.per_area = 0.1;
  const std::vector<std::string> warnings = frequency_warnings(s);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_THAT(warnings.front(),
              testing::HasSubstr("that of the polygons: feature number 0 (from 0) (4 instead of 1 m2);"));
  EXPECT_TRUE(is_of_frequencies(warnings.front()));
}

TEST(AnnualWeights, Contradictions) {
  Scenario s = plane(30.0, {0, 1});
  s.features[0].frequency = 0.3;
  refused(s, "feature number 1 (from 0) of the sources has no frequency, but others have");
  s.features[1].frequency = 0.1;
  s.frequency.per_area = 1.0;
  refused(s, "is given by the field frequency of the sources, frequency.per_area, must be given by one");
  s = plane(30.0, {0});
  s.frequency.per_area = 1.0;
  s.features[0].has_area = false;
  refused(s, "feature number 0 (from 0) of the sources is not of polygons alone");
  s = plane(30.0, {0});
  s.frequency.by_true_area = true;
  refused(s, "nothing says how often");
  s.frequency.per_area = 1.0;
  s.sources[0].point = true;
  refused(s, "a source is a point, which has no area");
  s = plane(30.0, {0});
  s.blocks.classes[0].frequency = 1.0;
  s.features[0].diameter = {1.0, 1.0};
  refused(s, "has a diameter of its own");
  s = plane(30.0, {0, 1});
  s.trajectories = 1'000'000'000;
  s.features[0].frequency = 1e-9;
  s.features[1].frequency = 1e6;
  refused(s, "too few beside all");
}

}  // namespace
}  // namespace talus
