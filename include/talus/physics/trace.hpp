#pragma once
#include <functional>

#include "talus/physics/effects.hpp"
#include "talus/physics/impact.hpp"
#include "talus/physics/path.hpp"

namespace talus {

/// When a block counts as stopped, and the bounds of a trajectory. docs/physics.md, "End of a trajectory".
struct EndRules {
  double stop_speed = 0.5;    ///< [m/s]
  double trap_time = 5.0;     ///< within one diameter of a place for so long: trapped [s]
  double time_limit = 600.0;  ///< [s]
  std::uint32_t impact_limit = 100'000;
};

/// Slower than this away from the smooth surface after an impact, a block slides [m/s].
inline constexpr double kSlideSpeed = 0.1;

/// All that a block meets. The surface and the cover are on the same grid.
struct World {
  const Surface& surface;
  const Cover& cover;
  ImpactModel impact;
  EndRules rules;
  const Effects* effects = nullptr;    ///< null: none
  const Barriers* barriers = nullptr;  ///< null: none
};

/// Walks one block from its release to its end: flights, impacts and slides in turn.
///
/// @param path  cleared first; on return the whole trajectory
///
/// A pure function of the world and the release: the same bits whoever calls it. Never throws; every loop is bounded.
void trace(const World& world, const Release& release, Path& path);

/// Walks the pieces that broke off a block, and those that break off them, in the order in which they broke off.
///
/// @param whole  the path of the block, traced as piece 0; not the buffer that `visit` gets
/// Together at most kMostPieces, each with its number as `Release::piece`.
void trace_pieces(const World& world, const Path& whole, const std::function<void(const Release&, const Path&)>& visit);

}  // namespace talus
