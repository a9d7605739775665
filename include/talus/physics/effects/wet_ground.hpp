#pragma once
#include <algorithm>

#include "talus/base/elementary.hpp"
#include "talus/physics/block.hpp"
#include "talus/physics/effects/effect_area.hpp"
#include "talus/physics/ground.hpp"

namespace talus {

/// Ground that is softer on wet days.
struct WetGround {
  double softening = 0.0;  ///< En50 is multiplied by exp(-softening) on a wet day [-]
  double drag = 0.0;       ///< Et50 is multiplied by exp(-drag) on a wet day [-]
  std::vector<int> days;   ///< the wet days
  EffectArea where;

  void change_ground(Ground& ground, const Block& block, int day) const;
};

/// Whether a day is wet.
inline bool is_wet(const WetGround& effect, int day) {
  return std::find(effect.days.begin(), effect.days.end(), day) != effect.days.end();
}

inline void WetGround::change_ground(Ground& ground, const Block& /*block*/, int day) const {
  if (!is_wet(*this, day)) return;
  ground.En50 *= exponential(-softening);  // docs/effects.md, "wet-ground"
  ground.Et50 *= exponential(-drag);
}

}  // namespace talus
