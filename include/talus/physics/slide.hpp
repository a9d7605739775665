#pragma once
#include "talus/physics/effects/rolling_resistance.hpp"
#include "talus/physics/ground.hpp"
#include "talus/physics/path.hpp"

namespace talus {

/// How a slide ended. docs/physics.md, "Sliding", rules (a) to (c).
enum class SlideEnd {
  Stopped,   ///< (a) friction holds the block
  Takeoff,   ///< (b) the ground falls away faster than the free parabola
  Asperity,  ///< (c) it has slid one diameter and meets the next asperity
  Caught,    ///< in a barrier
  Left       ///< over the edge of the terrain or onto missing data
};

/// Acceleration in plan of a block that slides on a patch [m/s^2]: gravity along the surface, Coulomb friction
/// tan(phi) g cos(beta) against the motion, and the turning of the surface, which keeps the speed.
///
/// @param slope    gradient of the surface [-];  twist: its mixed second derivative [1/m]
/// @param v        velocity in plan [m/s]; at rest the block is taken to start down the slope
/// Closed form for a bilinear surface: docs/physics.md, "Sliding".
Eigen::Vector2d sliding_acceleration(const Eigen::Vector2d& slope, double twist, const Eigen::Vector2d& v,
                                     double tan_phi);

/// Slides a block over the surface until one of the ends.
///
/// @param motion   on the surface of patch `at`, with a velocity along it; on return the state at the end
/// @param diameter D: how far it slides before the next asperity [m]
/// @param stop_speed  at most this fast, friction holds the block where it exceeds gravity [m/s]
/// @param path     gets one vertex and one span per piece
/// @param resistance  to rolling, adds to tan(phi) where it acts; null: none
///
/// Pieces of constant acceleration taken at their middle, each ending at the latest at the edge of its patch; the
/// length of a piece is chosen so that the position errs by less than D/1000 in it. At most 1 000 pieces.
SlideEnd slide(const Surface& surface, const Cover& cover, Motion& motion, PatchIndex& at, double diameter,
               double stop_speed, Path& path, const RollingResistance* resistance = nullptr);

}  // namespace talus
