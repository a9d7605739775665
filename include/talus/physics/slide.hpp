#pragma once
#include "talus/physics/effects/rolling_resistance.hpp"
#include "talus/physics/ground.hpp"
#include "talus/physics/path.hpp"

namespace talus {

/// How a slide ended. docs/physics.md, "Sliding", rules (a) to (c).
enum class SlideEnd {
  Stopped,       ///< (a) friction holds the block
  Trapped,       ///< walls hold the block, on ground where friction alone would not
  Takeoff,       ///< (b) the ground falls away below the free parabola
  NextAsperity,  ///< (c) it has slid one diameter and meets the next asperity
  Caught,        ///< in a barrier
  Left           ///< beyond the edge of the terrain or onto missing data
};

/// Acceleration in plan of a block that slides on a patch [m/s^2]: gravity along the surface, Coulomb friction
/// tan(phi) g cos(beta) against the motion, and the curvature of the surface, which does not change the speed.
///
/// @param slope    gradient of the surface [-]
/// @param twist    mixed second derivative of the height [1/m]
/// @param v        velocity in plan [m/s]; a block at rest starts down the slope
/// @param tan_phi  tangent of the friction angle [-]
///
/// Closed form for a bilinear surface: docs/physics.md, "Sliding".
Eigen::Vector2d sliding_acceleration(const Eigen::Vector2d& slope, double twist, const Eigen::Vector2d& v,
                                     double tan_phi);

/// How far the next asperity is: one diameter after the last.
struct WayToAsperity {
  double diameter;    ///< D [m]
  double slid = 0.0;  ///< since the last asperity [m]: 0 at an impact, more if the slide goes on behind a barrier
};

/// Slides a block over the surface to one of the ends above.
///
/// @param motion      on the surface of patch `at`, with a velocity along it; on return the state at the end
/// @param asperity    where the slide ends at the latest
/// @param stop_speed  a block no faster than this stops on ground no steeper than phi [m/s]
/// @param path        gets one vertex and one span per piece
/// @param resistance  rolling resistance, added to tan(phi) where it acts; null: none
///
/// Solved in pieces of constant acceleration, evaluated at their middle. A piece ends at the edge of its patch at the
/// latest, and at the border of its cell if friction changes there. Its length is chosen so that the error of the
/// position is less than D/1000 in it. At most 1 000 pieces.
SlideEnd slide(const Surface& surface, const Cover& cover, Motion& motion, PatchIndex& at, WayToAsperity asperity,
               double stop_speed, Path& path, const RollingResistance* resistance = nullptr);

}  // namespace talus
