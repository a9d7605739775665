#pragma once
#include "talus/physics/effects/effect_area.hpp"
#include "talus/physics/impact.hpp"

namespace talus {

/// Rest of slow blocks in the roughness of the ground: on talus steeper than its friction angle, too.
struct RestInRoughness {
  double kappa = 0.0;  ///< height that the block must be able to climb, in D tan(theta) [-]; 0: off
  EffectArea where;

  bool holds(const ImpactEnd& end) const;
};

/// Largest height that an asperity holds a block below, kappa D tan(theta) [m]. The speed v climbs v^2/(2 g).
inline double holding_height(const RestInRoughness& effect, const Block& block, const Asperity& asperity) {
  return effect.kappa * block.diameter * asperity.tan_theta;
}

/// Whether friction holds a block that leans on an asperity: slope - theta <= phi, the angles by their tangents.
///
/// @param normal  of the smooth surface, unit, upwards
inline bool leans(const Vec3& normal, double tan_theta, double tan_phi) {
  const double sine = std::sqrt(normal.x() * normal.x() + normal.y() * normal.y());
  return sine * (1.0 - tan_theta * tan_phi) <=
         (tan_theta + tan_phi) * normal.z();  // tan(theta + phi), without its pole
}

/// rest-in-roughness: v^2 < 2 g kappa D tan(theta) and slope - theta <= phi. docs/effects.md, "rest-in-roughness".
inline bool RestInRoughness::holds(const ImpactEnd& end) const {
  const double climb = 2.0 * kGravity * holding_height(*this, end.block, end.asperity);
  return end.velocity.squaredNorm() < climb && leans(end.normal, end.asperity.tan_theta, end.ground.tan_phi);
}

}  // namespace talus
