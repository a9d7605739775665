#include <gtest/gtest.h>

#include <algorithm>

#include "scenario_files.hpp"
#include "talus/simulate/scenario/block_sizes.hpp"

namespace talus::io {
namespace {

using test::ScenarioFile;

std::size_t size_warnings(const LoadedScenario& loaded) {
  return static_cast<std::size_t>(
      std::ranges::count_if(loaded.warnings, [](const std::string& w) { return w.starts_with(kSizeWarning); }));
}

constexpr const char* kMeasured = "[effects.block-mass]\npreset = \"measured\"\n";

/// The complete scenario has the numbers, no preset: reading it gives the same, with the origin in the record.
TEST_F(ScenarioFile, APresetOfAnEffectBecomesItsNumbers) {
  const BlockMass& numbers = find_preset("block-mass", "measured").numbers.block_mass;
  const LoadedScenario named = with(kMeasured);
  const BlockMass& read = named.scenario.effects.block_mass;
  EXPECT_EQ(read.roughness, numbers.roughness);
  EXPECT_EQ(read.stiffness, numbers.stiffness);
  EXPECT_EQ(read.reference_diameter, numbers.reference_diameter);
  EXPECT_TRUE(named.scenario.effects.any());
  EXPECT_TRUE(origin(named, "effects.block-mass.roughness").starts_with("preset measured: ")) << kMeasured;
  EXPECT_EQ(named.complete_toml.find("measured"), std::string::npos) << named.complete_toml;
  EXPECT_EQ(load(named.complete_toml).complete_toml, named.complete_toml);
  EXPECT_EQ(load(named.complete_toml).scenario.effects.block_mass.roughness, numbers.roughness);
}

TEST_F(ScenarioFile, NumbersBesideThePresetOfAnEffectCome) {
  const LoadedScenario l = with(std::string(kMeasured) + "roughness = 0.125\n");
  EXPECT_EQ(l.scenario.effects.block_mass.roughness, 0.125);
  EXPECT_EQ(origin(l, "effects.block-mass.roughness"), "scenario");
  EXPECT_TRUE(origin(l, "effects.block-mass.reference_diameter").starts_with("preset measured"));
}

TEST_F(ScenarioFile, APresetThatNoEffectHasIsRefused) {
  const std::string start = std::string(kFiles) + "[blocks]\ndiameter = 1\n";
  refused(start + "[effects.block-mass]\npreset = \"mesured\"\n",
          {"scenario.toml:7", "unknown preset 'mesured' of block-mass; did you mean 'measured'?"});
  refused(start + "[effects.soft-ground]\ndrag = 1\npreset = \"measured\"\n", {"unknown key 'preset'"});
  refused(start + "[effects.block-mass]\nreference_diameter = 1\n", {"must give roughness or stiffness, or preset"});
}

TEST_F(ScenarioFile, AShapeThatMultipliesEnergyIsSaid) {
  const auto said = [&](const std::string& shape) {
    for (const std::string& text : with("[ground.zones.default]\nshape = " + shape + "\n").warnings)
      if (text.find("gain energy") != std::string::npos) return text;
    return std::string();
  };
  for (const char* shape : {"[1, 1]", "[1, 1.5]", "[0.7, 1.2]"}) EXPECT_EQ(said(shape), "") << shape;
  EXPECT_NE(said("[0.5, 1]").find("by up to 45.9 %"), std::string::npos) << said("[0.5, 1]");  // the same at 2
  EXPECT_NE(said("[1, 2]").find("by up to 45.9 %"), std::string::npos) << said("[1, 2]");
}

TEST_F(ScenarioFile, SizesOutsideThoseOfThePresetAreSaidOnce) {
  EXPECT_EQ(size_warnings(with("")), 0U);  // 1.2 m
  const std::string small = std::string(kFiles) + "[blocks]\ndiameter = 0.5\n";
  EXPECT_EQ(size_warnings(load(small)), 1U);
  EXPECT_EQ(size_warnings(load(small + "[ground]\ndefault = \"quarry-floor-2d\"\n")), 1U);
  const std::string own = "[ground.zones.default]\ntheta_scale = 0.8\n";
  EXPECT_EQ(size_warnings(load(small + own)), 1U);  // En50 is still the preset's
  EXPECT_EQ(size_warnings(load(small + own + "En50 = 9\n")), 0U);
}

}  // namespace
}  // namespace talus::io
