#include "talus/products/hazard_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace talus {
namespace {

TEST(HazardTable, MapsHaveTheirNumber) {
  const HazardRules rules{EnergyBins({30.0, 2.5}), {}};
  HazardMatrix matrix;
  matrix.years = {50.0};
  std::vector<std::string> names;
  for (const HazardMap& map : hazard_maps_of(rules, matrix)) names.push_back(map.map.name);
  EXPECT_THAT(names, testing::UnorderedElementsAre("annual_frequency", "return_period_30", "return_period_2.5",
                                                   "intensity_T50", "hazard_class"));
  for (const HazardMap& map : hazard_maps_of(rules, matrix))
    for (const Map::Band& band : map.map.bands) EXPECT_THAT(band.name, testing::Not(testing::HasSubstr("<")));
}

TEST(HazardTable, MapsOfAnObjectSayItsWidth) {
  const HazardRules rules{EnergyBins({30.0}), {}};
  for (const HazardMap& map : hazard_maps_of(rules, {}, {10.0, 8.0})) {
    EXPECT_THAT(map.map.title, testing::HasSubstr("an object 10 m wide")) << map.map.name;
    EXPECT_THAT(map.map.title, testing::HasSubstr("lower than 8 m above the terrain")) << map.map.name;
    EXPECT_THAT(map.map.name, testing::Not(testing::HasSubstr("intensity")));
  }
  for (const HazardMap& map : hazard_maps_of(rules, {}, {10.0, 0.0}))
    EXPECT_THAT(map.map.title, testing::HasSubstr("at any height")) << map.map.name;
}

TEST(HazardTable, CurvesHaveABandPerEnergy) {
  const HazardRules rules{EnergyBins({2.5, 64.0}), {}};
  const auto names = [&](const ObjectWidth& object) {
    std::vector<std::string> of;
    for (const HazardMap& map : hazard_maps_of(rules, {}, object, true))
      if (map.map.name == "hazard_curves")
        for (const Map::Band& band : map.map.bands) of.push_back(band.name);
    return of;
  };
  EXPECT_EQ(names({}).size(), 1U + 18U + 1U) << "0, powers of two from 1 to 131 072, and 2.5; 64 is one of them";
  EXPECT_EQ(names({})[3], "annual frequency of E > 2.5 kJ (in plan, at any height)");
  EXPECT_THAT(names({10.0, 0.0}),
              testing::ElementsAre("annual frequency of E > 0 kJ of an object 10 m wide (in plan, at any height)",
                                   "annual frequency of E > 2.5 kJ of an object 10 m wide (in plan, at any height)",
                                   "annual frequency of E > 64 kJ of an object 10 m wide (in plan, at any height)"));
}

/// Where energies count the rotation, every map with energies says so.
TEST(HazardTable, MapsSayWhichEnergyCounts) {
  const HazardRules with{EnergyBins({30.0}), {}, true}, without{EnergyBins({30.0}), {}};
  for (const ObjectWidth& object : {ObjectWidth{}, ObjectWidth{10.0, 0.0}}) {
    for (const HazardMap& map : hazard_maps_of(with, {}, object, true)) {
      const bool of_energy = map.map.name != "annual_frequency";
      EXPECT_EQ(map.map.title.find("with rotation") != std::string::npos, of_energy) << map.map.title;
      EXPECT_EQ(map.map.title.find("ranslational"), std::string::npos) << map.map.title;
      for (const Map::Band& band : map.map.bands) EXPECT_EQ(band.name.find("E >"), std::string::npos) << band.name;
    }
    for (const HazardMap& map : hazard_maps_of(without, {}, object, true)) {
      EXPECT_EQ(map.map.title.find("rotation"), std::string::npos) << map.map.title;
      for (const Map::Band& band : map.map.bands) EXPECT_EQ(band.name.find("rotation"), std::string::npos) << band.name;
    }
  }
}

}  // namespace
}  // namespace talus
