#pragma once
#include <span>
#include <string_view>

#include "talus/physics/ground.hpp"

namespace talus {

/// A parameter set of the paper. docs/physics.md, "Parameter sets".
struct Preset {
  std::string_view name;  ///< "upper-talus-3d"
  Ground ground;
  std::string_view source;  ///< the table of the paper
  std::string_view where;   ///< the ground that it was fitted to
};

/// The ground of a scenario that names no other.
inline constexpr std::string_view kDefaultPreset = "upper-talus-3d";

/// All sets, in the order of the paper. The 2D sets have psi_scale = 0: they do not turn a block out of its plane.
std::span<const Preset> presets();

/// The set of this name. Throws InputError with the nearest name and all names.
const Preset& find_preset(std::string_view name);

}  // namespace talus
