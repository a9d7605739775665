#pragma once
#include <algorithm>

#include "talus/base/random.hpp"
#include "talus/physics/block.hpp"
#include "talus/physics/effects/effect_area.hpp"

namespace talus {

/// Single stems, met at random.
struct ForestStems {
  double density = 0.0;         ///< [stems per hectare]; 0: off
  double diameter = 0.3;        ///< DBH [m]
  double height = 20.0;         ///< of the trees [m]
  double species_factor = 1.0;  ///< of the energy a stem takes; 1: silver fir [-]
  EffectArea where;
};

/// forest-stems. docs/effects.md, "forest-stems".

/// Mean way in plan between two stems [m]: 10 000 / (N (DBH + D)), N per hectare.
inline double mean_way_between_stems(const ForestStems& forest, double diameter) {
  return 1e4 / (forest.density * (forest.diameter + diameter));
}

/// The most energy that a stem can take [J]: factor 38.7 DBH^2.31, DBH in cm. Source: Dorren & Berger (2006).
double stem_capacity(const ForestStems& forest);

/// Share of it that a stem takes when it is hit off its middle by e, -1 to 1 (0 full, +-1 at the edge): 0.98 to 0.
/// Source: the sigmoid of Dorren & Berger (2006), made symmetric, not below 0.
double stem_share(double eccentricity);

/// The velocity after a stem took an energy per mass from a block.
///
/// @param taken         [J/kg], at most 1/2 v^2
/// @param eccentricity  e in (-1, 1): > 0 where the stem's axis lies to the left of the way
///
/// The speed becomes sqrt(v^2 - 2 taken). In plan the way turns away from the stem as if the impulse went through its
/// axis: the part of the speed towards the axis, at the angle asin(e) from the way, bears the whole loss.
Vec3 velocity_after_stem(const Vec3& velocity, double taken, double eccentricity);

/// The stems that one block meets, by number; no encounter depends on how the earlier ones went.
class Stems {
 public:
  Stems(const ForestStems& forest, const Random& random);

  /// Way in plan inside the stand to the next stem [m].
  double way_left(double diameter) const { return std::max(0.0, left_) * mean_way_between_stems(forest_, diameter); }
  /// Goes a way inside the stand. Returns whether the next stem is reached.
  bool go(double way, double diameter);
  /// Meets it.
  Vec3 hit(const Vec3& velocity, double mass);

 private:
  void draw();

  const ForestStems& forest_;
  Random random_;
  std::uint32_t number_ = 0;  // of the next stem
  double left_ = 0.0;         // way to it, in mean ways
  double eccentricity_ = 0.0;
  double capacity_;  // [J]
};

}  // namespace talus
