#pragma once
#include <cstdint>

#include "talus/physics/impact.hpp"
#include "talus/terrain/surface.hpp"

namespace talus {

struct Effects;
class Barriers;

/// When a block counts as stopped, and the bounds of a trajectory. docs/physics.md, "End of a trajectory".
struct EndRules {
  double stop_speed = 0.5;    ///< [m/s]
  double trap_time = 5.0;     ///< within one diameter of a place for so long: trapped [s]
  double time_limit = 600.0;  ///< [s]
  std::uint32_t impact_limit = 100'000;
};

/// All that a block meets. The surface and the cover are on the same grid.
struct World {
  const Surface& surface;
  const Cover& cover;
  ImpactModel impact;
  EndRules rules;
  const Effects* effects = nullptr;    ///< null: none
  const Barriers* barriers = nullptr;  ///< null: none
};

}  // namespace talus
