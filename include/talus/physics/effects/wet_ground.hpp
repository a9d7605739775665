#pragma once
#include <algorithm>

#include "talus/base/elementary.hpp"
#include "talus/physics/effects.hpp"

namespace talus {

/// Whether a day is one of the wet ones.
inline bool is_wet(const WetGround& effect, int day) {
  return std::find(effect.days.begin(), effect.days.end(), day) != effect.days.end();
}

/// wet-ground: what En50 is multiplied by on a wet day. docs/effects.md, "wet-ground".
inline double wet_stiffness(const WetGround& effect) {
  return exponential(-effect.softening);
}

/// What Et50 is multiplied by on a wet day.
inline double wet_hold(const WetGround& effect) {
  return exponential(-effect.drag);
}

}  // namespace talus
