#pragma once
#include <cstdint>

#include "talus/physics/impact.hpp"
#include "talus/terrain/surface.hpp"

namespace talus {

struct Effects;
class Barriers;

/// Rules for the end of a trajectory, and its limits. docs/physics.md, "End of a trajectory".
struct EndRules {
  double stop_speed = 0.5;  ///< slower than this, a block can stop [m/s]
  double trap_time =
      5.0;  ///< a block that stays within one diameter for longer ends there [s]; above 2 m times sqrt(D / 2 m)
  double time_limit = 600.0;  ///< [s]
  std::uint32_t impact_limit = 100'000;
};

/// What a trajectory may cost. A search bounds it more than a run does. docs/physics.md, "End of a trajectory";
/// docs/diagnosis-time.md.
struct Effort {
  std::uint32_t most_vertices = 1'000'000;  ///< vertices after which a trajectory ends at its limit [-]
  double drag_loss = 0.04;                  ///< share of the speed that drag may take in one piece of a flight [-]
};

/// Patches crossed after which a trajectory ends at its limit, as with `Effort::most_vertices`: they bound its memory
/// and time where it flies over many patches between few vertices. docs/physics.md, "End of a trajectory".
inline constexpr std::size_t kMostSpans = 4'000'000;

/// Everything a block can meet. The surface and the cover are on the same grid.
struct World {
  const Surface& surface;
  const Cover& cover;
  ImpactModel impact;
  EndRules rules;
  const Effects* effects = nullptr;    ///< null: none
  const Barriers* barriers = nullptr;  ///< null: none
  Effort effort = {};
};

}  // namespace talus
