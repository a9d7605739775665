#pragma once
#include <functional>

#include "talus/physics/path.hpp"
#include "talus/physics/world.hpp"

namespace talus {

/// A block slides if its speed away from the smooth surface after an impact is below this [m/s].
inline constexpr double kSlideSpeed = 0.1;

/// Follows one block from its release to its end: flights, impacts and slides in turn.
///
/// @param path  cleared first; on return the whole trajectory
///
/// A pure function of the world and the release: the same bits for every caller. Every loop is bounded;
/// throws nothing but std::bad_alloc.
void trace(const World& world, const Release& release, Path& path);

/// Follows the pieces that broke off a block, then the pieces of these pieces, in the order of breaking. At most
/// kMostPieces in all; each has its number in `Release::piece`.
///
/// @param whole  the path of the block, traced as piece 0; not the buffer that `visit` gets
/// @param visit  called with each piece and its path
void trace_pieces(const World& world, const Path& whole, const std::function<void(const Release&, const Path&)>& visit);

}  // namespace talus
