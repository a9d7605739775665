#include "talus/simulate/scenario/presets.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "talus/base/error.hpp"
#include "talus/simulate/scenario/parameter_table.hpp"

namespace talus {

// docs/physics.md, "7 Parameter sets": Tables 1-3 of the paper.
TEST(Presets, AreThoseOfThePaper) {
  struct Row {
    const char* name;
    double theta_scale, psi_scale, en50, shape_max;
  };
  const Row rows[] = {{"firm-talus-2d", 0.7, 0, 15, 1.5},    {"forest-road-2d", 0.4, 0, 15, 1.5},
                      {"quarry-face-2d", 0.65, 0, 5, 1.0},   {"quarry-floor-2d", 0.35, 0, 5, 1.0},
                      {"upper-talus-3d", 1.0, 0.9, 15, 1.5}, {"forest-road-3d", 0.4, 0.3, 15, 1.5},
                      {"lower-talus-3d", 1.5, 1.0, 15, 1.5}};
  ASSERT_EQ(presets().size(), std::size(rows));
  for (const Row& row : rows) {
    const Ground& g = find_preset(row.name).ground;
    EXPECT_DOUBLE_EQ(g.theta_scale, row.theta_scale) << row.name;
    EXPECT_DOUBLE_EQ(g.psi_scale, row.psi_scale) << row.name;
    EXPECT_DOUBLE_EQ(g.En50, row.en50) << row.name;
    EXPECT_DOUBLE_EQ(g.Et50, 50.0) << row.name;
    EXPECT_NEAR(g.tan_phi, 1.0 / std::sqrt(3.0), 5e-16) << row.name;  // tan 30 deg
    EXPECT_DOUBLE_EQ(g.shape_min, 1.0) << row.name;
    EXPECT_DOUBLE_EQ(g.shape_max, row.shape_max) << row.name;
  }
}

TEST(Presets, AnUnknownOneNamesAll) {
  try {
    find_preset("Upper-talus-3D");
    FAIL();
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("did you mean 'upper-talus-3d'?"), std::string::npos) << message;
    for (const Preset& preset : presets()) EXPECT_NE(message.find(preset.name), std::string::npos) << message;
  }
}

/// The paper's simulations of Vaujany have 1.0 to 1.4 m; of the quarries it says nothing.
TEST(Presets, SayTheSizesThatTheyWereFittedTo) {
  for (const Preset& preset : presets()) {
    const bool quarry = preset.name.starts_with("quarry");
    EXPECT_EQ(preset.sizes.known(), !quarry) << preset.name;
    EXPECT_FALSE(preset.sizes.source.empty()) << preset.name;
    if (!quarry) EXPECT_EQ(preset.sizes.largest, 1.4) << preset.name;
    if (preset.name.ends_with("3d")) EXPECT_EQ(preset.sizes.smallest, 1.0) << preset.name;
  }
}

TEST(Presets, OfEffectsAreOffInTheOtherEffectsAndAllowed) {
  for (const EffectPreset& preset : effect_presets()) {
    EXPECT_TRUE(has_presets(preset.effect));
    for (const EffectEntry& entry : effect_entries()) {
      EXPECT_EQ(entry.acts(preset.numbers), entry.name == preset.effect) << preset.name;
      for (const EffectField& field : entry.fields())
        EXPECT_EQ(fault_of(field, field.get(preset.numbers)), std::nullopt) << field.key;
    }
  }
  EXPECT_FALSE(has_presets("soft-ground"));
}

}  // namespace talus
