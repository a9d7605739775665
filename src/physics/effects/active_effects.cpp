#include "active_effects.hpp"

namespace talus {

ActiveEffects::ActiveEffects(const World& world, const Release& release)
    : world_(world), effects_(*world.effects), release_(release) {
  if (effects_.vegetation_drag.coefficient > 0.0 || effects_.air_drag.coefficient > 0.0 ||
      effects_.forest_stems.density > 0.0)
    drag_.emplace(world, release);
}

Ground ActiveEffects::ground(const Vec3& place, const Block& body) {
  x_ = place.x(), y_ = place.y();
  zone_ = world_.cover.zone_at(x_, y_);
  Ground ground = world_.cover.grounds[zone_];
  for_each_effect(effects_, [&](const auto& effect) {
    if constexpr (requires { effect.change_ground(ground, body, 0); })
      if (here(effect)) effect.change_ground(ground, body, release_.day);
  });
  return ground;
}

Contact ActiveEffects::impact(const Ground& ground, const Block& body, const Motion& motion, const Vec3& normal,
                              const Asperity& asperity) {
  struct Changes {
    ActiveEffects& active;
    const Block& body;

    void restitution(Restitution& k) const {
      for_each_effect(active.effects_, [&](const auto& effect) {
        if constexpr (requires { effect.change_restitution(k, body); })
          if (active.here(effect)) effect.change_restitution(k, body);
      });
    }
    void rebound(Rebound& after, const ImpactMoment& moment) const {
      active.break_energy_ = break_energy(moment.v_n, moment.k.normal);
      for_each_effect(active.effects_, [&](const auto& effect) {
        if constexpr (requires { effect.change_rebound(after, moment); })
          if (active.here(effect)) effect.change_rebound(after, moment);
      });
    }
  };
  return talus::impact(world_.impact, ground, body, motion, normal, asperity, Changes{*this, body});
}

void ActiveEffects::after_impact(const Vec3& normal, Block& body, Motion& motion, Path& path) const {
  const Fragmentation& effect = effects_.fragmentation;
  if (effect.threshold > 0.0 && break_energy_ > effect.threshold && here(effect))
    break_up(effect, release_, normal, body, motion, path);
}

bool ActiveEffects::holds(const ImpactEnd& end) const {
  bool held = false;
  for_each_effect(effects_, [&](const auto& effect) {
    if constexpr (requires { effect.holds(end); }) held = held || (here(effect) && effect.holds(end));
  });
  return held;
}

FlightEnd ActiveEffects::fly(Motion& motion, PatchIndex& at, bool grounded, const Block& body, Path& path) {
  return drag_ ? drag_->fly(motion, at, grounded, body, path) : talus::fly(world_.surface, motion, at, grounded, path);
}

SlideEnd ActiveEffects::slide(Motion& motion, PatchIndex& at, const Block& body, Path& path, double slid) {
  const RollingResistance& rolling = effects_.rolling_resistance;
  return talus::slide(world_.surface, world_.cover, motion, at, {body.diameter, slid}, world_.rules.stop_speed, path,
                      rolling.coefficient > 0.0 ? &rolling : nullptr);
}

void ActiveEffects::after_slide(const Motion& before, const Block& body, Motion& motion, Path& path) {
  if (drag_) drag_->after_slide(before, body, motion, path);
}

}  // namespace talus
