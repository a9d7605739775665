#include "talus/products/hazard_maps.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "support/maps.hpp"
#include "support/scenarios.hpp"
#include "talus/simulate/simulate.hpp"

namespace talus {
namespace {

using test::three_sources;

/// Each field of the default matrix gives its class: frequencies of the column, up to the intensity of the row.
TEST(HazardMatrix, EveryField) {
  const HazardMatrix matrix;
  const std::vector<double> often{1.0 / 20, 1.0 / 60, 1.0 / 200, 1.0 / 900};  // in each column
  const int expected[3][4] = {{3, 2, 2, 1}, {4, 3, 3, 1}, {4, 4, 4, 1}};      // weak, medium, strong
  for (std::size_t intensity = 0; intensity < 3; ++intensity)
    for (std::size_t column = 0; column < 4; ++column) {
      std::vector<double> frequencies(3, 0.0);
      for (std::size_t i = 0; i <= intensity; ++i) frequencies[i] = often[column];
      EXPECT_EQ(class_of(matrix, frequencies), expected[intensity][column]) << intensity << ' ' << column;
      EXPECT_EQ(class_of(matrix, frequencies, false), column == 3 ? 0 : expected[intensity][column]);
    }
  EXPECT_EQ(class_of(matrix, std::vector<double>{0.0, 0.0, 0.0}), 0);
  EXPECT_EQ(class_of(matrix, std::vector<double>{1.0 / 30, 0.0, 0.0}), 3) << "the limit belongs to the shorter period";
}

TEST(HazardMatrix, TheGravestIntensityDecides) {  // weak every year, medium every 50, strong every 250 years
  EXPECT_EQ(class_of({}, std::vector<double>{1.0, 0.02, 0.004}), 4);
  EXPECT_EQ(class_of({}, std::vector<double>{0.005, 0.005, 0.001}), 3);
}

TEST(HazardMatrix, Faults) {
  HazardMatrix m;
  EXPECT_EQ(fault_of(m), "");
  m.classes[1][2] = 4;
  EXPECT_THAT(fault_of(m), testing::HasSubstr("nor rise with the return period"));
  m = {};
  m.classes.pop_back();
  EXPECT_THAT(fault_of(m), testing::HasSubstr("3 rows (weak first) of 4"));
  m = {};
  m.years = {30.0, 30.0, 300.0};
  EXPECT_THAT(fault_of(m), testing::HasSubstr("ascend"));
  m = {};
  m.names.pop_back();
  EXPECT_THAT(fault_of(m), testing::HasSubstr("4 has no name"));
}

HazardSurvey survey_of(const Tally& tally) {
  HazardSurvey survey(tally.grid(), tally.hazard_rules(), {});
  for (int row = 0; row < tally.grid().rows; ++row) {
    std::vector<HazardAt> cells;
    for (int column = 0; column < tally.grid().columns; ++column)
      if (const HazardCell* cell = tally.hazard(column, row)) cells.push_back({column, *cell, false});
    survey.set_row(row, std::vector<bool>(static_cast<std::size_t>(tally.grid().columns), row != 39), cells, 2);
  }
  EXPECT_EQ(survey.cells(), tally.touched_cells());
  return survey;
}

/// Band `band` of a map at a cell.
double at(const std::vector<Map>& maps, const std::string& name, int column, int row, std::size_t band = 0) {
  for (const Map& map : maps) {
    if (map.name != name) continue;
    std::vector<double> values(map.bands.size() * 40);
    test::fill_row(map, row, values);
    return values[band * 40 + static_cast<std::size_t>(column)];
  }
  ADD_FAILURE() << "no map " << name;
  return kNotGiven;
}

/// Cells with one curve each, from the tally to the map: one weight at 10, 100 or 1000 kJ.
TEST(HazardMaps, ACurveForEveryFieldOfTheMatrix) {
  const double unit = 0x1p-40;
  const WeightScale scale{unit, 0x1p-60, 1.0, static_cast<std::int64_t>(0.05 / unit), 1000, false};
  const HazardRules rules{EnergyBins({30.0, 300.0}), scale};
  const std::vector<double> often{1.0 / 20, 1.0 / 60, 1.0 / 200, 1.0 / 900};
  const int expected[3][4] = {{3, 2, 2, 1}, {4, 3, 3, 1}, {4, 4, 4, 1}};
  HazardSurvey survey(test::grid_of(12, 2, 2.0, 2.0), rules, {});
  std::vector<HazardAt> cells;
  for (int field = 0; field < 12; ++field) {
    const std::vector<float> energy{field < 4 ? 10.0F : field < 8 ? 100.0F : 1000.0F};
    const std::vector<AnnualShare> annual_share{
        {static_cast<std::int64_t>(often[static_cast<std::size_t>(field % 4)] / unit), 0, 10}};
    HazardCell cell;
    cell.add(rules, energy, annual_share);
    cells.push_back({field, cell, field == 5});
  }
  survey.set_row(0, std::vector<bool>(12, true), cells, 1);
  const std::vector<Map> maps = make_hazard_maps(survey);
  for (int field = 0; field < 12; ++field)
    EXPECT_EQ(at(maps, "hazard_class", field, 0), expected[field / 4][field % 4]) << field;
  const auto classes = std::ranges::find(maps, "hazard_class", &Map::name);
  ASSERT_EQ(classes->bands.back().name, "cut short");  // where paths leave the map
  std::vector<double> values(classes->bands.size() * 12);
  test::fill_row(*classes, 0, values);
  for (std::size_t field = 0; field < 12; ++field)
    EXPECT_EQ(values[values.size() - 12 + field], field == 5 ? 1.0 : 0.0) << field;
}

/// A cell passed with six energies, of which four lie beside 30 and 64 kJ: its curve is a staircase.
TEST(HazardMaps, HazardCurveOfSixEnergies) {
  const double unit = 0x1p-40;
  const WeightScale scale{unit, 0x1p-60, 1.0, static_cast<std::int64_t>(0.05 / unit), 1000, false};
  const HazardRules rules{EnergyBins({30.0, 300.0}), scale};
  const std::vector<float> passed{10.0F, 29.9F, 30.1F, 63.9F, 64.1F, 1000.0F};
  const std::vector<double> often{0.05, 0.02, 0.01, 0.005, 0.002, 0.001};
  HazardCell cell;
  std::vector<AnnualShare> annual_shares;
  for (const double f : often) annual_shares.push_back({static_cast<std::int64_t>(f / unit), 0, 10});
  cell.add(rules, passed, annual_shares);
  HazardSurvey survey(test::grid_of(2, 1, 2.0, 2.0), rules, {}, {}, true);
  survey.set_row(0, {true, true}, std::vector<HazardAt>{{0, cell, false}}, 1);
  const std::vector<Map> maps = make_hazard_maps(survey);
  const auto map = std::ranges::find(maps, "hazard_curves", &Map::name);
  ASSERT_NE(map, maps.end());
  const std::vector<double> energies = energies_of_curves(rules, {});
  EXPECT_THAT(energies, testing::IsSupersetOf({0.0, 1.0, 8.0, 16.0, 30.0, 64.0, 128.0, 300.0, 131072.0}));
  ASSERT_EQ(map->bands.size(), energies.size());
  std::vector<double> values(2 * energies.size());
  test::fill_row(*map, 0, values);
  for (std::size_t i = 0; i < energies.size(); ++i) {
    double expected = 0.0;
    for (std::size_t k = 0; k < passed.size(); ++k) expected += passed[k] > energies[i] ? often[k] : 0.0;
    EXPECT_NEAR(values[2 * i], expected, 1e-8) << energies[i];
    EXPECT_EQ(values[2 * i + 1], 0.0) << "nothing passes the other cell";
  }
  for (const HazardMap& other : hazard_maps_of(rules, {}))
    EXPECT_NE(other.map.name, "hazard_curves") << "not asked for";
}

TEST(HazardMaps, ThreeSourcesOnAPlane) {
  const Scenario s = three_sources();
  Tally tally(s.surface.grid(), s.output.energy_thresholds, s.output.height_thresholds);
  tally.keep_hazard(*AnnualWeights::of(s));
  simulate(s, tally, {}, 2);
  const HazardSurvey survey = survey_of(tally);
  const std::vector<Map> maps = make_hazard_maps(survey);
  std::map<std::string, int> names;
  for (const Map& map : maps) ++names[map.name];
  for (const char* name : {"annual_frequency", "return_period_30", "return_period_300", "intensity_T30",
                           "intensity_T100", "intensity_T300", "hazard_class"})
    EXPECT_EQ(names[name], 1) << name;

  EXPECT_NEAR(at(maps, "annual_frequency", 10, 15), 0.5, 1e-6);
  EXPECT_NEAR(at(maps, "annual_frequency", 20, 33), 0.02, 1e-6) << "above the third source";
  EXPECT_NEAR(at(maps, "annual_frequency", 20, 15), 0.021, 1e-6) << "below both";
  EXPECT_EQ(at(maps, "annual_frequency", 30, 15), 0.0);
  EXPECT_NEAR(at(maps, "annual_frequency", 30, 15, 2), 0.5 / 30 * 3.689, 1e-4) << "of no trajectory";
  EXPECT_TRUE(std::isnan(at(maps, "annual_frequency", 30, 39))) << "no terrain";
  // 1.4 t, and 50 m below the source: above 300 kJ, as a smooth block on 45 degrees is at 20 m/s and more.
  EXPECT_NEAR(at(maps, "return_period_300", 10, 5), 2.0, 1e-5);
  EXPECT_NEAR(at(maps, "return_period_300", 20, 5), 1.0 / 0.021, 1e-3);
  EXPECT_TRUE(std::isnan(at(maps, "return_period_300", 30, 5)));
  EXPECT_GT(at(maps, "intensity_T30", 10, 5), 300.0);
  EXPECT_EQ(at(maps, "intensity_T30", 20, 5), 0.0) << "47 years are rarer than 30";
  EXPECT_GT(at(maps, "intensity_T100", 20, 5), 300.0);
  EXPECT_EQ(at(maps, "hazard_class", 10, 5), 4.0);
  EXPECT_EQ(at(maps, "hazard_class", 10, 5, 1), 4.0);
  EXPECT_EQ(at(maps, "hazard_class", 10, 5, 3), 0.0) << "it can be told";
  EXPECT_EQ(at(maps, "hazard_class", 30, 5), 0.0);
  EXPECT_EQ(at(maps, "hazard_class", 30, 5, 2), 4.0) << "0.06 per year may pass, unseen, of any energy";
  EXPECT_EQ(at(maps, "hazard_class", 30, 5, 3), 1.0) << "it cannot be told";
}

}  // namespace
}  // namespace talus
