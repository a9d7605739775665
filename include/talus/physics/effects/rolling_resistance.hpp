#pragma once
#include <algorithm>

#include "talus/physics/effects/effect_area.hpp"
#include "talus/physics/impact.hpp"

namespace talus {

/// Resistance to rolling. It acts when the block hops lower than a share of its radius.
struct RollingResistance {
  double coefficient = 0.0;  ///< mu_r [-]; 0: off
  double hop = 0.5;          ///< highest hop that counts as rolling, in radii [-]
  EffectArea where;

  void change_rebound(Rebound& after, const ImpactMoment& moment) const;
};

/// Whether a block counts as rolling: the height of its hop, v^2/(2 g cos beta), is below `hop` radii.
///
/// @param away      v, speed away from the smooth surface after the impact [m/s], >= 0
/// @param cos_beta  cosine of the slope angle [-]
/// @param radius    of the block [m]
inline bool is_rolling(const RollingResistance& effect, double away, double cos_beta, double radius) {
  return away * away < 2.0 * kGravity * cos_beta * effect.hop * radius;
}

/// rolling-resistance: share of the tangential speed, and of the spin about axes in the plane, left after an impact.
///
///   1 - min(1, 5/7 mu_r P / v_t)
///
/// @param v_t      tangential speed after the impact [m/s]
/// @param impulse  P, normal impulse per mass [m/s]
///
/// A resisting moment mu_r R P reduces both so that the block keeps rolling: a block of inertia 2/5 m R^2 slows down by
/// 5/7 mu_r g cos(beta). Source: Azzoni et al. (1995); docs/effects.md, "rolling-resistance".
inline double rolling_keeps(const RollingResistance& effect, double v_t, double impulse) {
  const double loss = 5.0 / 7.0 * effect.coefficient * impulse;
  return loss < v_t ? 1.0 - loss / v_t : 0.0;
}

inline void RollingResistance::change_rebound(Rebound& after, const ImpactMoment& moment) const {
  const double away = std::max(0.0, after.velocity.dot(moment.normal));
  if (!(coefficient > 0.0) || !is_rolling(*this, away, moment.normal.z(), moment.block.radius())) return;
  const double v_t = (after.velocity - after.velocity.dot(moment.plane) * moment.plane).norm();
  const double kept = rolling_keeps(*this, v_t, (1.0 + moment.k.normal) * moment.v_n);
  scale_along(after.velocity, moment.plane, kept);
  scale_along(after.spin, moment.plane, kept);
}

}  // namespace talus
