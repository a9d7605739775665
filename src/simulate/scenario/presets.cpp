#include "talus/simulate/scenario/presets.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "talus/base/error.hpp"
#include "talus/base/text.hpp"
#include "talus/simulate/scenario/parameter_table.hpp"

namespace talus {

namespace {

// theta_scale, psi_scale, En50 [m^3/s^2], largest shape factor; in every table Et50 = 50, phi = 30 deg, shape from 1.
Ground ground_of(double theta_scale, double psi_scale, double en50, double shape_max) {
  Ground ground{theta_scale, psi_scale, en50, 50.0, 0.0, 1.0, shape_max};
  for (const auto& field : ground_fields())
    if (field.key == "phi") field.set(ground, 30.0);
  return ground;
}

constexpr FittedSizes kVaujany{1.0, 1.4, "the paper's simulations of Vaujany"};
constexpr FittedSizes kVaujanyOnly{1.0, 1.4, "not stated in 2D; the paper's simulations of Vaujany in 3D"};
constexpr FittedSizes kVaujanyEhime{
    0.4, 1.4, "not stated; Ehime 0.12 to 2.06 t (Ushiro et al. 2006), Vaujany as the paper simulates it in 3D"};
constexpr FittedSizes kQuarry{kNotGiven, kNotGiven, "not stated; not known of the quarries"};
constexpr FittedSizes kGuess{kNotGiven, kNotGiven, "none: a first guess, from the Rn of Rockyfor3D at 1 m", false};
constexpr std::string_view kRockyfor3d = "migration.md";

/// Ground that keeps next to nothing of a blow: water, swamp.
Ground swallowing_ground() {
  Ground ground = ground_of(0.0, 0.0, 0.01, 1.0);
  ground.Et50 = 0.01;
  return ground;
}

// Mitchell & Hungr, PIERRE 2; then a first guess for the soil types of Rockyfor3D: docs/migration.md, and
// tools/scripts/studies/migration_study.py, which prints the En50.
const std::array<Preset, 15>& all() {
  static const std::array<Preset, 15> presets{{
      {"firm-talus-2d", ground_of(0.7, 0.0, 15.0, 1.5), "Table 1", "firm talus, Vaujany and Ehime, in 2D",
       kVaujanyEhime},
      {"forest-road-2d", ground_of(0.4, 0.0, 15.0, 1.5), "Table 1", "forest road, in 2D", kVaujanyOnly},
      {"quarry-face-2d", ground_of(0.65, 0.0, 5.0, 1.0), "Table 2", "face of a quarry, in 2D", kQuarry},
      {"quarry-floor-2d", ground_of(0.35, 0.0, 5.0, 1.0), "Table 2", "floor of a quarry, in 2D", kQuarry},
      {"upper-talus-3d", ground_of(1.0, 0.9, 15.0, 1.5), "Table 3", "upper talus, Vaujany, in 3D", kVaujany},
      {"forest-road-3d", ground_of(0.4, 0.3, 15.0, 1.5), "Table 3", "forest road, Vaujany, in 3D", kVaujany},
      {"lower-talus-3d", ground_of(1.5, 1.0, 15.0, 1.5), "Table 3", "lower talus, Vaujany, in 3D", kVaujany},
      {"rockyfor3d-0", swallowing_ground(), kRockyfor3d, "soil type 0: river, swamp", kGuess},
      {"rockyfor3d-1", ground_of(0.4, 0.3, 1.82, 1.5), kRockyfor3d, "soil type 1: fine soil, deep", kGuess},
      {"rockyfor3d-2", ground_of(0.4, 0.3, 2.5, 1.5), kRockyfor3d, "soil type 2: fine soil, shallow", kGuess},
      {"rockyfor3d-3", ground_of(1.0, 0.9, 3.25, 1.5), kRockyfor3d, "soil type 3: scree, compact soil", kGuess},
      {"rockyfor3d-4", ground_of(1.0, 0.9, 4.07, 1.5), kRockyfor3d, "soil type 4: talus", kGuess},
      {"rockyfor3d-5", ground_of(0.65, 0.6, 4.96, 1.5), kRockyfor3d, "soil type 5: bedrock, thin cover", kGuess},
      {"rockyfor3d-6", ground_of(0.65, 0.6, 6.94, 1.5), kRockyfor3d, "soil type 6: bedrock", kGuess},
      {"rockyfor3d-7", ground_of(0.4, 0.3, 3.57, 1.5), kRockyfor3d, "soil type 7: asphalt road", kGuess},
  }};
  return presets;
}

// Exponents: docs/effects.md, "block-mass"; tools/scripts/studies/size_study.py prints them. D0 is the middle of the
// sizes of the 3D sets of the paper, at which these sets stay as they are.
const std::array<EffectPreset, 1>& all_of_effects() {
  static const std::array<EffectPreset, 1> presets{{
      {"block-mass", "measured", "fitted to Tschamut and Authume, blocks of 0.3 to 1.1 m",
       FittedSizes{0.3, 1.1, "blocks of Tschamut and Authume"},
       [] {
         Effects effects;
         effects.block_mass = {.roughness = 0.7, .stiffness = 1.5, .reference_diameter = 1.2, .where = {}};
         return effects;
       }()},
  }};
  return presets;
}

}  // namespace

std::span<const Preset> presets() {
  return all();
}

const Preset& find_preset(std::string_view name) {
  std::vector<std::string> names;
  for (const Preset& preset : all()) {
    if (preset.name == name) return preset;
    names.emplace_back(preset.name);
  }
  throw InputError("unknown preset '" + std::string(name) + "'" + known_names(name, names));
}

std::span<const EffectPreset> effect_presets() {
  return all_of_effects();
}

bool has_presets(std::string_view effect) {
  return std::ranges::any_of(all_of_effects(), [&](const EffectPreset& p) { return p.effect == effect; });
}

const EffectPreset& find_preset(std::string_view effect, std::string_view name) {
  std::vector<std::string> names;
  for (const EffectPreset& preset : all_of_effects()) {
    if (preset.effect != effect) continue;
    if (preset.name == name) return preset;
    names.emplace_back(preset.name);
  }
  throw InputError("unknown preset '" + std::string(name) + "' of " + std::string(effect) + known_names(name, names));
}

}  // namespace talus
