#pragma once
#include "talus/base/elementary.hpp"
#include "talus/physics/block.hpp"
#include "talus/physics/effects.hpp"

namespace talus {

/// block-mass: what theta_scale is multiplied by, (D0/D)^roughness. docs/effects.md, "block-mass".
inline double size_roughness(const BlockMass& effect, const Block& block) {
  return power(effect.reference_diameter / block.diameter, effect.roughness);
}

/// What En50 is multiplied by, (D/D0)^stiffness; stiffness 1 cancels the D of the deformation energy.
inline double size_stiffness(const BlockMass& effect, const Block& block) {
  return power(block.diameter / effect.reference_diameter, effect.stiffness);
}

}  // namespace talus
