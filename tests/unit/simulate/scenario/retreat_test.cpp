#include "talus/simulate/scenario/retreat.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/scenarios.hpp"
#include "talus/simulate/plan/plan.hpp"
#include "talus/simulate/scenario/frequency.hpp"

namespace talus {
namespace {

/// 10 source cells of 2 m on a plane of 60 degrees: 40 m2 in plan, 80 m2 of rock face.
Scenario cliff() {
  Scenario s = test::scenario_on(
      test::terrain(test::grid_of(20, 20, 2.0, 2.0), [](double x, double) { return x * std::tan(radians(60.0)); }));
  s.features.assign(1, SourceFeature{});
  s.sources.clear();
  for (int i = 0; i < 10; ++i) s.sources.push_back({0, 5.0 + 2.0 * i, 7.0, false});
  s.trajectories = 10;
  return s;
}

TEST(AnnualRock, IsEventsTimesTheVolumeOfASphere) {
  Scenario s = cliff();
  EXPECT_FALSE(annual_rock(s).has_value());
  s.features[0].diameter = {2.0, 2.0};
  s.features[0].frequency = 3.0;
  const AnnualRock rock = annual_rock(s).value();
  EXPECT_NEAR(rock.events, 3.0, 1e-9);
  EXPECT_NEAR(rock.volume, 3.0 * 4.0 / 3.0 * kPi, 1e-9);
  EXPECT_NEAR(rock.area, 80.0, 1e-3);
  EXPECT_NEAR(rock.retreat(), kPi / 20.0, 1e-5);
}

/// The rock of two of three features is compared with their cells: one is of points, which have no area. A cell of two
/// features counts once.
TEST(AnnualRock, IsComparedWithTheCellsOfPolygonsEachOnce) {
  Scenario s = cliff();
  s.features.assign(3, {.frequency = 1.0, .diameter = {2.0, 2.0}});
  for (int i = 0; i < 10; ++i) s.sources.push_back({1, 5.0 + 2.0 * i, 7.0, false});
  s.sources.push_back({2, 7.0, 7.0, true});
  const AnnualRock rock = annual_rock(s).value();
  EXPECT_NEAR(rock.volume, 3.0 * 4.0 / 3.0 * kPi, 1e-9);
  EXPECT_NEAR(rock.from_area, 2.0 * 4.0 / 3.0 * kPi, 1e-9);
  EXPECT_NEAR(rock.area, 80.0, 1e-3);
  for (SourceFeature& feature : s.features) feature.has_area = false;  // lines
  EXPECT_TRUE(std::isnan(annual_rock(s)->retreat()));
}

/// The mean volume of 4000 drawn blocks is the expected one, within five standard errors.
TEST(AnnualRock, HasTheVolumesThatAreDrawn) {
  Scenario s = cliff();
  s.frequency.total = 1.0;
  s.trajectories = 400;
  s.blocks.classes = {{{0.5, 2.0}, 3.0}, {{1.0, 3.0}, 1.0}};
  double sum = 0.0, squares = 0.0;
  for (std::uint32_t source = 0; source < 10; ++source)
    for (std::uint32_t block = 0; block < 400; ++block) {
      const double volume = make_release(s, source, block).body.mass / s.blocks.density;
      sum += volume, squares += volume * volume;
    }
  const double mean = sum / 4000.0, deviation = std::sqrt(squares / 4000.0 - mean * mean);
  EXPECT_NEAR(annual_rock(s)->volume, mean, 5.0 * deviation / std::sqrt(4000.0));
}

/// Diameters of 1 to 3 m, uniform: the mean of d^3 is (3^4 - 1) / (4 (3 - 1)) = 10 m3.
TEST(AnnualRock, TakesTheMeanOfTheVolumesNotOfTheDiameters) {
  Scenario s = cliff();
  s.blocks.classes = {{{1.0, 3.0}, 1.0}};
  s.frequency.total = 6.0 / kPi;
  EXPECT_NEAR(annual_rock(s)->volume, 10.0, 1e-9);
}

/// Two classes with events of their own, drawn in other shares, and two without, drawn 3 to 1.
TEST(AnnualRock, OfClassesIsByTheirEventsOrElseByTheirShares) {
  Scenario s = cliff();
  s.blocks.classes = {{{1.0, 1.0}, 1.0, 0.9}, {{4.0, 4.0}, 5.0, 0.1}};
  EXPECT_NEAR(annual_rock(s)->volume, kPi / 6.0 * (0.9 + 0.1 * 64.0), 1e-9);
  s.blocks.classes = {{{1.0, 1.0}, 3.0}, {{4.0, 4.0}, 1.0}};
  s.frequency.total = 1.0;
  EXPECT_NEAR(annual_rock(s)->volume, kPi / 6.0 * (0.75 + 0.25 * 64.0), 1e-9);
}

/// Density of volumes with N(>= V) = V^-1 from 1 to e m3: V^-2 / (1 - 1/e); the mean is 1 / (1 - 1/e). With N = V^-2:
/// 2 (1 - 1/e) / (1 - 1/e^2) = 2 / (1 + 1/e).
TEST(AnnualRock, OfAPowerLawIsItsMean) {
  Scenario s = cliff();
  const double e = std::exp(1.0);
  s.blocks.classes.clear();
  s.blocks.power_law = {{1.0, e}, 1.0};
  s.frequency.total = 1.0;
  EXPECT_NEAR(annual_rock(s)->volume, 1.0 / (1.0 - 1.0 / e), 1e-9);
  s.blocks.power_law.exponent = 2.0;
  EXPECT_NEAR(annual_rock(s)->volume, 2.0 / (1.0 + 1.0 / e), 1e-9);
}

/// 0.001 events per m2 and year of 0.5 m3 from 40 m2 in plan bring 0.02 m3 from 80 m2 of face, 0.25 mm a year. Per
/// hectare typed as per m2 it is 2.5 m a year.
TEST(RetreatWarning, ComesWhereEventsPerHectareWereTypedAsPerSquareMetre) {
  Scenario s = cliff();
  const double diameter = std::cbrt(0.5 * 6.0 / kPi);
  s.blocks.classes = {{{diameter, diameter}, 1.0}};
  s.frequency.per_area = 0.001;
  EXPECT_NEAR(annual_rock(s)->retreat(), 0.25e-3, 1e-7);
  EXPECT_EQ(retreat_warning(s), "");
  s.frequency.per_area = 10.0;
  EXPECT_THAT(retreat_warning(s),
              testing::StartsWith("frequencies: 200 m3 of rock a year fall from the polygons, 80 m2 of "
                                  "surface, which would go back by 2.5 m a year; 2 mm a year is"));
  EXPECT_TRUE(is_of_frequencies(retreat_warning(s)));
}

/// The cliff of 80 m2 with 100 m3 a year, and beside it one of 80 m2 with almost none: it is not averaged out.
TEST(RetreatWarning, IsOfThePolygonThatGoesBackFastest) {
  Scenario s = cliff();
  const double diameter = std::cbrt(6.0 / kPi);  // 1 m3
  s.features.assign(2, {.name = "quiet", .frequency = 1e-6, .diameter = {diameter, diameter}});
  for (int i = 0; i < 10; ++i) s.sources.push_back({1, 5.0 + 2.0 * i, 11.0, false});
  EXPECT_EQ(retreat_warning(s), "");
  s.features[1].name = "wrong", s.features[1].frequency = 100.0;
  EXPECT_THAT(retreat_warning(s),
              testing::StartsWith("frequencies: 100 m3 of rock a year fall from the polygon 'wrong', 80 m2 of surface, "
                                  "which would go back by 1.25 m a year;"));
}

/// Two features on the same cells, each of 6 m3 a year from 80 m2: 0.075 m a year each, 0.15 together. One block a year
/// from a small polygon is no wrong unit.
TEST(RetreatWarning, AddsFeaturesOfTheSameCellsAndAllowsOneBlockAYear) {
  Scenario s = cliff();
  const double diameter = std::cbrt(6.0 / kPi);  // 1 m3
  s.features.assign(1, {.frequency = 6.0, .diameter = {diameter, diameter}});
  EXPECT_EQ(retreat_warning(s), "");
  s.features.assign(2, s.features[0]);
  for (int i = 0; i < 10; ++i) s.sources.push_back({1, 5.0 + 2.0 * i, 7.0, false});
  EXPECT_THAT(retreat_warning(s), testing::HasSubstr("12 m3 of rock a year fall from the polygons, 80 m2"));
  const double large = std::cbrt(4.0 * 6.0 / kPi);  // 4 m3, once a year from a cell of 8 m2, beside 80 m2 without
  s.features[0].frequency = 0.0;
  s.features[1] = {.frequency = 1.0, .diameter = {large, large}};
  s.sources.resize(10);
  s.sources.push_back({1, 35.0, 7.0, false});
  EXPECT_EQ(retreat_warning(s), "");
}

}  // namespace
}  // namespace talus
