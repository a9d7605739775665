#pragma once
#include "talus/physics/block.hpp"
#include "talus/physics/effects/effect_area.hpp"
#include "talus/physics/impact.hpp"

namespace talus {

/// Soft soil in which the block ploughs a scar.
struct SoftGround {
  double drag = 0.0;         ///< C_d of the soil [-]; 0: off
  double stiffness = 15.0;   ///< M_E [MN/m^2]
  double scar_length = 1.5;  ///< [m]
  EffectArea where;

  void change_rebound(Rebound& after, const ImpactMoment& moment) const;
};

inline constexpr double kSoilDensity = 1700.0;  ///< [kg/m^3]

/// Depth of the scar of an impact [m]: 0.1 m^(1/3) M_E^(-0.4) v_n^0.8, at most the radius; here M_E is in kN/m^2.
///
/// @param v_n  speed into the ground [m/s], >= 0
/// Source: Lu et al. (2019); docs/effects.md, "soft-ground".
double scar_depth(const SoftGround& soft, const Block& block, double v_n);

/// Area of a segment of a circle with height d, 0 <= d <= radius [m^2].
///
/// Error: below 1e-14 of the area of the circle. Uses + - * / and square roots only.
double segment_area(double radius, double d);

/// soft-ground: share of the tangential speed left after an impact, exp(-1/2 C_d rho A(d) L / m).
double scar_keeps(const SoftGround& soft, const Block& block, double v_n);

inline void SoftGround::change_rebound(Rebound& after, const ImpactMoment& moment) const {
  if (drag > 0.0) scale_along(after.velocity, moment.plane, scar_keeps(*this, moment.block, moment.v_n));
}

}  // namespace talus
