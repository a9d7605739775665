#pragma once
#include "talus/base/elementary.hpp"
#include "talus/physics/block.hpp"
#include "talus/physics/effects/effect_area.hpp"
#include "talus/physics/ground.hpp"

namespace talus {

/// How roughness and damping change with the size of the block.
struct BlockMass {
  double roughness = 0.0;           ///< theta_scale is multiplied by (D0/D)^roughness [-]
  double stiffness = 0.0;           ///< En50 is multiplied by (D/D0)^stiffness [-]
  double reference_diameter = 1.0;  ///< D0 [m]
  EffectArea where;

  void change_ground(Ground& ground, const Block& block, int day) const;
};

/// block-mass: factor on theta_scale, (D0/D)^roughness. docs/effects.md, "block-mass".
inline double size_roughness(const BlockMass& effect, const Block& block) {
  return power(effect.reference_diameter / block.diameter, effect.roughness);
}

/// Factor on En50, (D/D0)^stiffness. A stiffness of 1 cancels the D of the deformation energy.
inline double size_stiffness(const BlockMass& effect, const Block& block) {
  return power(block.diameter / effect.reference_diameter, effect.stiffness);
}

inline void BlockMass::change_ground(Ground& ground, const Block& block, int /*day*/) const {
  ground.theta_scale *= size_roughness(*this, block);
  ground.En50 *= size_stiffness(*this, block);
}

}  // namespace talus
