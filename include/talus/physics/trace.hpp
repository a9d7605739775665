#pragma once
#include <functional>

#include "talus/physics/path.hpp"
#include "talus/physics/world.hpp"

namespace talus {

/// Slower than this away from the smooth surface after an impact, a block slides [m/s].
inline constexpr double kSlideSpeed = 0.1;

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
