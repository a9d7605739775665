#include "talus/simulate/scenario/block_sizes.hpp"

#include <gtest/gtest.h>

namespace talus {
namespace {

Scenario of_diameter(double low, double high) {
  Scenario scenario;
  scenario.features = {SourceFeature{}};
  scenario.blocks.classes = {BlockClass{{low, high}}};
  return scenario;
}

std::string warning(const Scenario& scenario, std::string_view preset = "upper-talus-3d") {
  const std::vector<const Preset*> presets{&find_preset(preset), &find_preset(preset)};
  return size_warning(scenario, presets);
}

TEST(BlockSizes, OfClassesFeaturesAndPowerLaws) {
  Scenario scenario = of_diameter(0.5, 0.7);
  scenario.blocks.classes.push_back({{2.0, 3.0}});
  EXPECT_EQ(diameters_of(scenario), (Range{0.5, 3.0}));
  scenario.features[0].diameter = {1.0, 1.1};  // all features have their own: the classes are not used
  EXPECT_EQ(diameters_of(scenario), (Range{1.0, 1.1}));
  scenario.features.push_back({});
  EXPECT_EQ(diameters_of(scenario), (Range{0.5, 3.0}));
  scenario.blocks.classes.clear();
  scenario.blocks.power_law.volume = {kPi / 6.0, 8.0 * kPi / 6.0};  // spheres of 1 and 2 m
  EXPECT_NEAR(diameters_of(scenario).low, 1.0, 1e-15);
  EXPECT_NEAR(diameters_of(scenario).high, 2.0, 1e-15);
}

/// 1200 blocks: a class of the share p is drawn 1200 p times.
TEST(BlockSizes, AClassThatIsHardlyDrawnIsSaid) {
  Scenario scenario = of_diameter(1.0, 1.0);
  scenario.sources.resize(20);
  scenario.trajectories = 60;
  scenario.blocks.classes[0].frequency = 0.9;
  scenario.blocks.classes.push_back({{3.0, 3.0}});
  scenario.blocks.classes[1].frequency = 0.1;
  for (const auto& [weight, said] : {std::pair{1.0, false}, {0.02, false}, {0.01, true}, {0.0005, true}}) {
    scenario.blocks.classes[1].weight = weight;
    const std::string text = rare_class_warning(scenario);
    EXPECT_EQ(!text.empty(), said) << weight << text;
  }
  const std::string text = rare_class_warning(scenario);
  EXPECT_NE(
      text.find(
          "3 m (10 % of the events, about 0.6 of 1200 blocks in a round: if there is none, its events are in the total "
          "and in no map)"),
      std::string::npos)
      << text;
  scenario.blocks.classes[1].weight = 0.01;
  EXPECT_NE(rare_class_warning(scenario).find("blocks in a round): give"), std::string::npos) << "some are drawn";
  scenario.blocks.classes[1].frequency = 0.0;  // it carries no events
  EXPECT_EQ(rare_class_warning(scenario), "");
}

TEST(BlockSizes, WarnsOutsideAndNotInside) {
  EXPECT_EQ(warning(of_diameter(1.0, 1.4)), "");
  EXPECT_EQ(warning(of_diameter(1.2, 1.2)), "");
  for (const Scenario& scenario : {of_diameter(0.99, 1.2), of_diameter(1.2, 1.41), of_diameter(0.3, 4.0)}) {
    const std::string text = warning(scenario);
    EXPECT_TRUE(text.starts_with(kSizeWarning)) << text;
    EXPECT_NE(text.find("upper-talus-3d (1 to 1.4 m)"), std::string::npos) << text;
    EXPECT_EQ(text.find("upper-talus-3d"), text.rfind("upper-talus-3d")) << "once: " << text;
    const Range d = diameters_of(scenario);
    EXPECT_EQ(text.find("larger blocks: run-out and speed too low (unsafe)") != std::string::npos, d.high > 1.4)
        << text;
    EXPECT_EQ(text.find("smaller blocks: at both measured sites they went farther") != std::string::npos, d.low < 1.0)
        << text;
    EXPECT_EQ(text.find("block-mass") != std::string::npos, d.high > 1.4)
        << "it shortens the ways of small ones: " << text;
  }
  EXPECT_NE(warning(of_diameter(0.3, 4.0)).find("diameters are 0.3 to 4 m"), std::string::npos);
}

TEST(BlockSizes, SaysWhatIsNotKnownWhatBreaksAndWhatIsScaled) {
  EXPECT_NE(warning(of_diameter(1.2, 1.2), "quarry-face-2d").find("to are not known: quarry-face-2d"),
            std::string::npos);
  Scenario scenario = of_diameter(1.2, 1.2);
  scenario.effects.block_mass.roughness = 0.5;
  EXPECT_EQ(warning(scenario), "");
  scenario.effects.fragmentation.threshold = 100.0;
  const std::string text = warning(scenario);
  EXPECT_NE(text.find("of pieces less"), std::string::npos) << text;
  EXPECT_NE(text.find("[effects.block-mass] changes"), std::string::npos) << text;
  EXPECT_EQ(text.find("smaller blocks"), std::string::npos) << text;
}

TEST(BlockSizes, AGuessIsSaidAsSuch) {
  EXPECT_EQ(warning(of_diameter(5.0, 5.0), "rockyfor3d-4"), "");
  const std::vector<const Preset*> presets{&find_preset("rockyfor3d-4"), &find_preset("upper-talus-3d"),
                                           &find_preset("rockyfor3d-4"), &find_preset("rockyfor3d-0")};
  const std::string text = guess_warning(presets);
  EXPECT_TRUE(text.starts_with(kGuessWarning)) << text;
  EXPECT_NE(text.find("ground rockyfor3d-4, rockyfor3d-0 is"), std::string::npos) << text;
  EXPECT_EQ(guess_warning(std::span(presets).subspan(1, 1)), "");
}

}  // namespace
}  // namespace talus
