#pragma once
#include <cmath>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "talus/physics/effects/registry.hpp"
#include "talus/physics/ground.hpp"

namespace talus {

/// Diameters of the blocks that a parameter set was fitted to [m]. NaN: not known.
struct FittedSizes {
  double smallest, largest;
  std::string_view source;  ///< where the paper, or the literature about its site, says so
  bool fitted = true;       ///< false: the set is a first guess that no data support
  bool of_pieces = false;   ///< blocks may have broken in the fit, so that pieces are smaller there, too
  double tolerance = 1e-9;  ///< share by which diameters may be outside

  bool known() const { return !std::isnan(smallest); }
};

/// A parameter set of the paper (docs/physics.md, "Parameter sets"), or a first guess for the ground of another program
/// (docs/migration.md).
struct Preset {
  std::string_view name;  ///< "upper-talus-3d"
  Ground ground;
  std::string_view source;  ///< the table of the paper, or the page of the docs
  std::string_view where;   ///< the ground that it was fitted to
  FittedSizes sizes;
};

/// The ground of a scenario, or of a profile, that names no other.
inline constexpr std::string_view kDefaultPreset = "upper-talus-3d", kDefaultProfilePreset = "firm-talus-2d";

/// All sets, in the order of the paper, then those of other programs. The 2D sets have psi_scale = 0: they do not turn
/// a block out of its plane.
std::span<const Preset> presets();

/// Whether a set is of the 2D model. Ground that swallows blocks has no roughness at all.
inline bool is_of_plane(const Preset& preset) {
  return preset.ground.psi_scale == 0.0 && preset.ground.theta_scale > 0.0;
}

/// The set of this name. Throws InputError with the nearest name and all names.
const Preset& find_preset(std::string_view name);

/// A parameter set of an effect. docs/effects.md, in the section of the effect.
struct EffectPreset {
  std::string_view effect, name;  ///< "block-mass", "measured"
  std::string_view source;        ///< where its numbers come from
  FittedSizes sizes;
  Effects numbers;  ///< only those of this effect are used
};

/// All sets of effects.
std::span<const EffectPreset> effect_presets();

/// Whether there are sets of this effect.
bool has_presets(std::string_view effect);

/// The set of this name of an effect. Throws InputError with the nearest name and all names.
const EffectPreset& find_preset(std::string_view effect, std::string_view name);

}  // namespace talus
