#pragma once
#include <algorithm>

#include "talus/base/random.hpp"
#include "talus/physics/block.hpp"
#include "talus/physics/effects/effect_area.hpp"

namespace talus {

/// Single stems, met at random.
struct ForestStems {
  static constexpr bool kLeavesPlane = true;
  double density = 0.0;         ///< [stems per hectare]; 0: off
  double diameter = 0.3;        ///< DBH [m]
  double height = 20.0;         ///< of the trees [m]
  double species_factor = 1.0;  ///< factor on the energy a stem takes; 1: silver fir [-]
  EffectArea where;
};

/// forest-stems. docs/effects.md, "forest-stems".

/// Mean way in plan between two stems [m]: 10 000 / (N (DBH + D)), N per hectare.
inline double mean_way_between_stems(const ForestStems& forest, double diameter) {
  return 1e4 / (forest.density * (forest.diameter + diameter));
}

/// The most energy that a stem can take [J]: factor 38.7 DBH^2.31, DBH in cm. Source: Dorren & Berger (2006).
double stem_capacity(const ForestStems& forest);

/// Share of this energy that a stem takes at a hit with eccentricity e: 0.98 at 0 (middle), 0 at -1 and 1 (edge).
/// Source: the sigmoid of Dorren & Berger (2006), made symmetric and cut at 0.
double stem_share(double eccentricity);

/// Velocity of a block after a stem took energy from it.
///
/// @param taken         energy per mass [J/kg], at most 1/2 v^2
/// @param eccentricity  e in (-1, 1): > 0 if the axis of the stem is left of the way
///
/// The speed becomes sqrt(v^2 - 2 taken). In plan the way turns away from the stem as if the impulse went through its
/// axis: only the part of the speed towards the axis, at the angle asin(e) from the way, decreases.
Vec3 velocity_after_stem(const Vec3& velocity, double taken, double eccentricity);

/// The stems that one block meets, by number. A draw does not depend on the results of earlier hits.
class Stems {
 public:
  Stems(const ForestStems& forest, const Random& random);

  /// Way in plan inside the stand to the next stem [m].
  double way_left(double diameter) const { return std::max(0.0, left_) * mean_way_between_stems(forest_, diameter); }
  /// Moves the block by a way in plan inside the stand [m]. Returns whether it reached the next stem.
  bool go(double way, double diameter);
  /// Velocity after a hit on the next stem; then draws the stem after it.
  Vec3 hit(const Vec3& velocity, double mass);

 private:
  void draw();

  const ForestStems& forest_;
  Random random_;
  std::uint32_t number_ = 0;  // of the next stem
  double left_ = 0.0;         // way to it, as a multiple of the mean way
  double eccentricity_ = 0.0;
  double capacity_;  // [J]
};

}  // namespace talus
