#pragma once
#include <optional>

#include "physics/drag_flight.hpp"
#include "talus/physics/flight.hpp"
#include "talus/physics/slide.hpp"
#include "talus/physics/world.hpp"

namespace talus {

/// The plain engine, for a run without effects.
class Effectless {
 public:
  Effectless(const World& world, const Release&) : world_(world) {}

  const Ground& ground(const Vec3& place, const Block&) const {
    return world_.cover.grounds[world_.cover.zone_at(place.x(), place.y())];
  }
  Contact impact(const Ground& ground, const Block& body, const Motion& motion, const Vec3& normal,
                 const Asperity& asperity) const {
    return talus::impact(world_.impact, ground, body, motion, normal, asperity);
  }
  static void after_impact(const Vec3&, Block&, Motion&, Path&) {}
  static bool holds(const ImpactEnd&) { return false; }
  FlightEnd fly(Motion& motion, PatchIndex& at, bool grounded, const Block&, Path& path) const {
    return talus::fly(world_.surface, motion, at, grounded, path);
  }
  SlideEnd slide(Motion& motion, PatchIndex& at, const Block& body, Path& path, double slid = 0.0) const {
    return talus::slide(world_.surface, world_.cover, motion, at, {body.diameter, slid}, world_.rules.stop_speed, path);
  }
  static void after_slide(const Motion&, const Block&, Motion&, Path&) {}

 private:
  const World& world_;
};

/// The engine with effects, with the functions of Effectless. An effect at its off value changes no bit.
class ActiveEffects {
 public:
  ActiveEffects(const World& world, const Release& release);

  /// The ground of a place for this block on this day, after `change_ground` of each effect that has one.
  Ground ground(const Vec3& place, const Block& body);
  /// The impact law with `change_restitution` and `change_rebound` of each effect, at the place of the last call of
  /// `ground`.
  Contact impact(const Ground& ground, const Block& body, const Motion& motion, const Vec3& normal,
                 const Asperity& asperity);
  /// fragmentation: breaks the block if the last impact was hard enough.
  void after_impact(const Vec3& normal, Block& body, Motion& motion, Path& path) const;
  /// Whether `holds` of an effect keeps the block at the place of the last call of `ground`.
  bool holds(const ImpactEnd& end) const;
  /// A flight with vegetation-drag, air-drag and forest-stems.
  FlightEnd fly(Motion& motion, PatchIndex& at, bool grounded, const Block& body, Path& path);
  /// A slide with rolling-resistance.
  SlideEnd slide(Motion& motion, PatchIndex& at, const Block& body, Path& path, double slid = 0.0);
  /// The three of a flight, at the end of a slide that began with the motion `before`.
  void after_slide(const Motion& before, const Block& body, Motion& motion, Path& path);
  /// Flights with these three; null: all flights are free.
  DragFlight* drag_flight() { return drag_ ? &*drag_ : nullptr; }

 private:
  template <class Effect>
  bool here(const Effect& effect) const {
    if constexpr (requires { effect.where; })
      return effect.where.covers(zone_, x_, y_);
    else
      return true;
  }

  const World& world_;
  const Effects& effects_;
  const Release& release_;
  std::optional<DragFlight> drag_;
  std::uint8_t zone_ = 0;  // of the place of `ground`, as x_ and y_
  double x_ = 0.0, y_ = 0.0, break_energy_ = 0.0;
};

}  // namespace talus
