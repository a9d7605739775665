#include "active_effects.hpp"

#include <algorithm>
#include <cmath>

#include "talus/physics/effects/block_mass.hpp"
#include "talus/physics/effects/block_shape.hpp"
#include "talus/physics/effects/fragmentation.hpp"
#include "talus/physics/effects/rolling_resistance.hpp"
#include "talus/physics/effects/soft_ground.hpp"
#include "talus/physics/effects/wet_ground.hpp"

namespace talus {
namespace {

/// Scales the part of a vector along the plane of normal `n`.
void scale_along(Vec3& vector, const Vec3& n, double factor) {
  const Vec3 across = vector.dot(n) * n;
  vector = factor * (vector - across) + across;
}

}  // namespace

ActiveEffects::ActiveEffects(const World& world, const Release& release)
    : world_(world), effects_(*world.effects), release_(release), wet_(is_wet(effects_.wet_ground, release.day)) {
  if (effects_.vegetation_drag.coefficient > 0.0 || effects_.air_drag.coefficient > 0.0 ||
      effects_.forest_stems.density > 0.0)
    drag_.emplace(world, release);
}

Ground ActiveEffects::ground(const Vec3& place, const Block& body) {
  x_ = place.x(), y_ = place.y();
  zone_ = world_.cover.zone_at(x_, y_);
  Ground ground = world_.cover.grounds[zone_];
  if (here(effects_.block_shape.where)) ground.psi_scale *= shape_scatter(effects_.block_shape, body);
  if (here(effects_.block_mass.where)) {
    ground.theta_scale *= size_roughness(effects_.block_mass, body);
    ground.En50 *= size_stiffness(effects_.block_mass, body);
  }
  if (wet_ && here(effects_.wet_ground.where)) {
    ground.En50 *= wet_stiffness(effects_.wet_ground);
    ground.Et50 *= wet_hold(effects_.wet_ground);
  }
  return ground;
}

Contact ActiveEffects::impact(const Ground& ground, const Block& body, const Motion& motion, const Vec3& normal,
                              const Asperity& asperity) {
  const RoughPlane plane = rough_plane(normal, motion.velocity, met_by(world_.impact, asperity));
  const double v_n = std::max(0.0, -motion.velocity.dot(plane.normal));
  Restitution k = restitution(ground, world_.impact.deformation_coefficient * body.diameter * v_n * v_n);
  if (here(effects_.block_shape.where)) k.tangential *= shape_keeps(effects_.block_shape, body);
  Rebound after =
      rebound(motion.velocity, motion.spin, plane.normal, k, asperity.shape * body.radius(), ground.tan_phi);
  break_energy_ = break_energy(v_n, k.normal);

  const SoftGround& soft = effects_.soft_ground;
  if (soft.drag > 0.0 && here(soft.where)) scale_along(after.velocity, plane.normal, scar_keeps(soft, body, v_n));

  const RollingResistance& rolling = effects_.rolling_resistance;
  if (rolling.coefficient > 0.0 && here(rolling.where) &&
      is_rolling(rolling, std::max(0.0, after.velocity.dot(normal)), normal.z(), body.radius())) {
    const double v_t = (after.velocity - after.velocity.dot(plane.normal) * plane.normal).norm();
    const double kept = rolling_keeps(rolling, v_t, (1.0 + k.normal) * v_n);
    scale_along(after.velocity, plane.normal, kept);
    scale_along(after.spin, plane.normal, kept);
  }
  const double into_slope = std::min(0.0, after.velocity.dot(normal));
  return {after.velocity - into_slope * normal, after.spin, plane.psi_dropped};
}

void ActiveEffects::after_impact(const Vec3& normal, Block& body, Motion& motion, Path& path) const {
  const Fragmentation& effect = effects_.fragmentation;
  if (effect.threshold > 0.0 && break_energy_ > effect.threshold && here(effect.where))
    break_up(effect, release_, normal, body, motion, path);
}

Outcome ActiveEffects::fly(Motion& motion, PatchIndex& at, bool grounded, const Block& body, Path& path) {
  return drag_ ? drag_->fly(motion, at, grounded, body, path) : talus::fly(world_.surface, motion, at, grounded, path);
}

SlideEnd ActiveEffects::slide(Motion& motion, PatchIndex& at, const Block& body, Path& path) {
  const RollingResistance& rolling = effects_.rolling_resistance;
  const Motion before = motion;
  const SlideEnd end = talus::slide(world_.surface, world_.cover, motion, at, body.diameter, world_.rules.stop_speed,
                                    path, rolling.coefficient > 0.0 ? &rolling : nullptr);
  if (drag_ && end != SlideEnd::Left && end != SlideEnd::Stopped) drag_->after_slide(before, motion, body);
  return end;
}

}  // namespace talus
