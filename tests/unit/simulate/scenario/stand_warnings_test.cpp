#include "talus/simulate/scenario/stand_warnings.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/scenarios.hpp"
#include "talus/base/text.hpp"

namespace talus {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// 10 x 10 cells of 20 m: four hectares. With the effects that a forest needs.
Scenario on_four_hectares() {
  Scenario s = test::scenario_on(Raster<float>(test::grid_of(10, 10, 20.0, 20.0), 100.0F));
  s.effects.block_mass.roughness = 0.7;
  s.effects.rest_in_roughness.kappa = 0.2;
  return s;
}

std::vector<std::string> of_forest(const Scenario& s) {
  return stand_warnings(*find_effect("forest-stems"), s);
}

/// Warnings of a forest of equal stems.
std::vector<std::string> of_stand(double density, double diameter) {
  Scenario s = on_four_hectares();
  s.effects.forest_stems.density = density, s.effects.forest_stems.diameter = diameter;
  return of_forest(s);
}

/// Warnings of a forest from rasters, in 60 of the 100 cells.
std::vector<std::string> of_rasters(double density, double diameter) {
  Scenario s = on_four_hectares();
  auto map = std::make_shared<ForestMap>();
  map->density = Raster<float>(s.surface.grid(), 0.0F);
  map->diameter = Raster<float>(s.surface.grid(), static_cast<float>(diameter));
  for (int row = 0; row < 10; ++row)
    for (int column = 0; column < 6; ++column) map->density.at(column, row) = static_cast<float>(density);
  s.effects.forest_stems.map = std::move(map);
  s.effects.forest_stems.density = density;
  return of_forest(s);
}

/// Warnings of a forest from a list of trees: `per_side` x `per_side` trees on one hectare, none on the others.
std::vector<std::string> of_list(int per_side, double diameter) {
  Scenario s = on_four_hectares();
  std::vector<Tree> trees;
  for (int i = 0; i < per_side; ++i)
    for (int j = 0; j < per_side; ++j)
      trees.push_back({{100.0 * (i + 0.5) / per_side, 100.0 * (j + 0.5) / per_side}, diameter, 1.0});
  auto map = std::make_shared<ForestMap>();
  map->trees = TreeList(trees);
  s.effects.forest_stems.map = std::move(map);
  s.effects.forest_stems.density = 0.25 * per_side * per_side;
  return of_forest(s);
}

/// The number after some words of a warning.
double number_after(const std::string& text, const std::string& words) {
  return number_in(text.substr(text.find(words) + words.size()));
}

TEST(StandWarnings, AForestThatNoStandCanBe) {
  EXPECT_THAT(of_stand(450.0, 0.35), IsEmpty());  // 43 m2/ha
  EXPECT_THAT(of_rasters(450.0, 0.35), IsEmpty());
  EXPECT_THAT(of_list(21, 0.35), IsEmpty());  // 441 trees on a hectare
  for (const auto& warnings :
       {of_stand(4500.0, 0.35), of_rasters(4500.0, 0.35), of_list(67, 0.35),  // ten times as many
        of_stand(450.0, 1.1), of_rasters(450.0, 1.1), of_list(21, 1.1)})      // the girth
    EXPECT_THAT(warnings, ElementsAre(HasSubstr("more wood than any stand has")));
  EXPECT_THAT(of_stand(0.045, 0.35), ElementsAre(HasSubstr("the median density of the forest is 0.045 stems/ha")));
  EXPECT_THAT(of_rasters(0.045, 0.35), ElementsAre(HasSubstr("the median density of the forest is 0.045 stems/ha")));
}

TEST(StandWarnings, AForestWithoutTheEffectsThatItNeeds) {
  Scenario s = on_four_hectares();
  s.effects.forest_stems.density = 450.0, s.effects.forest_stems.diameter = 0.35;
  s.effects.block_mass = {};
  EXPECT_THAT(of_forest(s), ElementsAre(HasSubstr("holds large blocks best without [effects.block-mass]")));
  s.effects.rest_in_roughness = {};
  EXPECT_THAT(of_forest(s), ElementsAre(HasSubstr("without [effects.block-mass]"),
                                        HasSubstr("keeps few blocks without [effects.rest-in-roughness]")));
}

/// N pi/4 DBH^2, to the 1 % of the median.
TEST(StandWarnings, TheBasalAreaIsThatOfTheStems) {
  const std::string words = "basal area of the forest is about ";
  EXPECT_NEAR(number_after(of_stand(4500.0, 0.35).at(0), words), 4500.0 * kPi / 4.0 * 0.35 * 0.35, 5.0);
  EXPECT_NEAR(number_after(of_rasters(450.0, 1.1).at(0), words), 450.0 * kPi / 4.0 * 1.1 * 1.1, 5.0);
  EXPECT_NEAR(number_after(of_list(21, 1.1).at(0), words), 441.0 * kPi / 4.0 * 1.1 * 1.1, 5.0);
  // 100 m2/ha at N = 1000: DBH = 0.3568 m.
  EXPECT_THAT(of_stand(1000.0, 0.353), IsEmpty());
  EXPECT_THAT(of_stand(1000.0, 0.360), testing::SizeIs(1));
}

TEST(StandWarnings, ASmallOddPartOfAForestIsNone) {
  Scenario s = on_four_hectares();
  auto map = std::make_shared<ForestMap>();
  map->density = Raster<float>(s.surface.grid(), 450.0F);
  map->diameter = Raster<float>(s.surface.grid(), 0.35F);
  for (int row = 0; row < 4; ++row) map->diameter.at(0, row) = 1.5F, map->density.at(1, row) = 2.0F;
  s.effects.forest_stems.map = std::move(map);
  s.effects.forest_stems.density = 450.0;
  EXPECT_THAT(of_forest(s), IsEmpty());
}

/// c/m = 4 1/s for m = rho pi/6 D^3.
TEST(StandWarnings, DragThatHoldsTheSmallestBlocksInTheAir) {
  const auto of_drag = [](double coefficient, const Scenario& s) {
    Scenario with = s;
    with.effects.vegetation_drag.coefficient = coefficient;
    return stand_warnings(*find_effect("vegetation-drag"), with);
  };
  Scenario s = on_four_hectares();
  s.blocks.density = 2700.0;
  s.blocks.classes = {{{0.9, 1.1}, 1.0, kNotGiven}, {{0.4, 0.6}, 3.0, kNotGiven}};
  const double limit = 4.0 * 2700.0 * kPi / 6.0 * 0.4 * 0.4 * 0.4;  // 362 kg/s
  EXPECT_THAT(of_drag(0.999 * limit, s), IsEmpty());
  EXPECT_THAT(of_drag(1.001 * limit, s), testing::SizeIs(1));
  // 750/90.48 = 8.29; D at c/m = 4: (6 750/(4 pi 2700))^(1/3) = 0.51 m.
  EXPECT_THAT(of_drag(750.0, s),
              ElementsAre(testing::AllOf(HasSubstr("of 0.4 m, lose c/m = 8.29 1/s"), HasSubstr("here below 0.51 m"))));
  s.blocks.classes = {{{1.0, 1.0}, 1.0, kNotGiven}};
  EXPECT_THAT(of_drag(750.0, s), IsEmpty());
}

}  // namespace
}  // namespace talus
