#include "talus/simulate/scenario/acting_effects.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/scenarios.hpp"

namespace talus {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// 6 x 4 cells of 5 m, that of the north-western corner without a height. The two western columns are zone 1.
Scenario with_two_zones() {
  const Grid grid = test::grid_of(6, 4, 5.0, 5.0);
  Raster<float> heights(grid, 100.0F);
  heights.at(0, 3) = std::numeric_limits<float>::quiet_NaN();
  Scenario s = test::scenario_on(std::move(heights));
  s.cover.grounds = {Ground{}, Ground{}};
  s.zone_names = {"default", "west"};
  s.cover.zones = Raster<std::uint8_t>(grid, 0);
  for (int row = 0; row < 4; ++row)
    for (const int column : {0, 1}) s.cover.zones.at(column, row) = 1;
  return s;
}

/// A stand of 450 stems/ha, of 0.5 m, in the eastern three columns; elsewhere none.
std::shared_ptr<const ForestMap> forest_in_the_east() {
  const Grid grid = test::grid_of(6, 4, 5.0, 5.0);
  auto map = std::make_shared<ForestMap>();
  map->density = Raster<float>(grid, 0.0F);
  for (int row = 0; row < 4; ++row)
    for (const int column : {3, 4, 5}) map->density.at(column, row) = 450.0F;
  map->density.at(5, 0) = 2500.0F;
  map->diameter = Raster<float>(grid, 0.5F);
  return map;
}

TEST(EffectsInUse, NoneWithoutAStrength) {
  Scenario s = with_two_zones();
  s.effects.forest_stems.diameter = 0.8;
  s.effects.wet_ground.days = {0};
  EXPECT_TRUE(effects_in_use(s).empty());
}

TEST(EffectsInUse, EachEffectOfTheRegistryActsInAllCells) {
  for (const EffectEntry& entry : effect_entries()) {
    Scenario s = with_two_zones();
    s.blocks.axes = {1.5, 1.2, 1.0};
    if (std::vector<int>* days = entry.days(s.effects)) *days = {4, s.day};
    const auto strength = std::ranges::find_if(entry.fields(), [](const EffectField& f) { return f.is_strength(); });
    strength->set(s.effects, 0.5);
    const auto uses = effects_in_use(s);
    ASSERT_EQ(uses.size(), 1U) << entry.name;
    EXPECT_EQ(uses[0].entry->name, entry.name);
    EXPECT_EQ(uses[0].cells, 23U) << entry.name;
    EXPECT_TRUE(uses[0].acts()) << uses[0].idle;
    EXPECT_THAT(uses[0].text, StartsWith(std::string(entry.name) + " acts in 23 of 23 cells (0.0575 ha): "));
    EXPECT_THAT(uses[0].text, HasSubstr(std::string(entry.key_of(*strength)) + " = 0.5"));
  }
}

TEST(EffectsInUse, AreasAreCounted) {
  Scenario s = with_two_zones();
  s.effects.vegetation_drag.coefficient = 250.0;
  s.effects.vegetation_drag.where.zones = {0, 1};
  EXPECT_THAT(effects_in_use(s)[0].text, StartsWith("vegetation-drag acts in 7 of 23 cells (0.0175 ha): "
                                                    "coefficient = 250 kg/s, height = 10 m"));
  s.effects.vegetation_drag.where = {};
  s.effects.vegetation_drag.where.mask = Raster<std::uint8_t>(s.surface.grid(), 0);
  const auto off = effects_in_use(s);
  EXPECT_FALSE(off[0].acts());
  EXPECT_EQ(off[0].cells, 0U);
  EXPECT_THAT(off[0].idle, HasSubstr("[effects.vegetation-drag] acts nowhere"));
  s.effects.vegetation_drag.where.mask.at(4, 1) = 1;
  EXPECT_EQ(effects_in_use(s)[0].cells, 1U);
}

TEST(EffectsInUse, AForestActsWhereItStandsAndItsAreaAllows) {
  Scenario s = with_two_zones();
  s.effects.forest_stems.map = forest_in_the_east();
  s.effects.forest_stems.density = 2500.0;  // the largest, as it is read
  // Mean of 11 cells of 450 and one of 2500.
  EXPECT_THAT(effects_in_use(s)[0].text,
              StartsWith("forest-stems acts in 12 of 23 cells (0.03 ha): density = 450 to 2500 (mean 621) 1/ha, "
                         "diameter = 0.5 m, height = 20 m"));
  s.effects.forest_stems.where.zones = {0, 1};  // in the west, where no tree stands
  const auto uses = effects_in_use(s);
  EXPECT_EQ(uses[0].cells, 0U);
  EXPECT_THAT(uses[0].idle, HasSubstr("no cell of the DEM with a forest"));
  EXPECT_TRUE(uses[0].text.empty());
}

TEST(EffectsInUse, ListedTreesAreInTheirCells) {
  Scenario s = with_two_zones();
  auto map = std::make_shared<ForestMap>();
  map->trees = TreeList({{{7.0, 7.0}, 0.4, 1.0}, {{8.0, 8.0}, 0.4, 1.0}, {{22.0, 3.0}, 0.4, 1.0}});
  s.effects.forest_stems.map = std::move(map);
  s.effects.forest_stems.density = 60.0;
  const auto uses = effects_in_use(s);
  EXPECT_EQ(uses[0].cells, 2U);
  EXPECT_THAT(uses[0].text, testing::Not(HasSubstr("density")));
}

TEST(EffectsInUse, OtherDaysAndSpheresAreIdle) {
  Scenario s = with_two_zones();
  s.effects.wet_ground.softening = 1.0;
  s.effects.wet_ground.days = {5};
  s.effects.block_shape.lateral = 0.5;
  for (const EffectUse& use : effects_in_use(s)) EXPECT_THAT(use.idle, HasSubstr("does nothing here"));
  s.day = 5;
  s.blocks.axes = {1.5, 1.2, 1.0};
  for (const EffectUse& use : effects_in_use(s)) EXPECT_TRUE(use.acts()) << use.idle;
}

TEST(EffectsInUse, AProfileIsMeasuredAlongItsWay) {
  Scenario s = with_two_zones();
  s.impact.in_plane = true;
  s.surface = Surface(Raster<float>(s.surface.grid(), 100.0F));
  s.effects.soft_ground.drag = 2.0;
  s.effects.soft_ground.where.zones = {0, 1};
  EXPECT_THAT(effects_in_use(s)[0].text, StartsWith("soft-ground acts along 10 of 25 m: drag = 2, "));
}

}  // namespace
}  // namespace talus
