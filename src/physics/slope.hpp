#pragma once
#include <cmath>

#include "talus/physics/slide.hpp"

namespace talus {

/// The patch a block slides on, in metres: what the pieces of a slide need.
struct Slope {
  const Surface& surface;
  PatchIndex at;
  double tan_phi;
  Patch patch{};

  /// Reads the patch; false where there is none.
  bool read() { return surface.read(at, patch); }

  double p_of(const Eigen::Vector2d& place) const { return surface.u_of(place.x()) - at.column; }
  double q_of(const Eigen::Vector2d& place) const { return surface.v_of(place.y()) - at.row; }
  double height(const Eigen::Vector2d& place) const { return patch.height(p_of(place), q_of(place)); }
  Eigen::Vector2d gradient(const Eigen::Vector2d& place) const {
    return surface.gradient(patch, p_of(place), q_of(place));
  }
  /// Mixed second derivative of the height [1/m].
  double twist() const { return patch.twist * surface.per_cell_x() * surface.per_cell_y(); }

  Eigen::Vector2d acceleration(const Eigen::Vector2d& place, const Eigen::Vector2d& v) const {
    return sliding_acceleration(gradient(place), twist(), v, tan_phi);
  }
  /// How hard the surface presses back [m/s^2]: negative where the ground falls away faster than the free parabola.
  double press(const Eigen::Vector2d& v) const { return kGravity + 2.0 * twist() * v.x() * v.y(); }
};

/// A velocity in plan as one along the surface.
inline Vec3 along(const Eigen::Vector2d& v, const Eigen::Vector2d& gradient) {
  return {v.x(), v.y(), v.dot(gradient)};
}

/// Writes a piece of sliding into the path: a vertex and a span. Pieces that take no time leave no trace.
void record_piece(Path& path, const Slope& slope, const Motion& before, const Motion& after);

/// Time in which a block of speed `s` and acceleration `a` covers a distance [s]; at most `longest`.
double time_to_cover(double distance, double s, double a, double longest);

/// What came of a piece along a crease.
enum class CreaseEnd { Moved, Held };

/// Slides a block along the concave edge between two patches that both press it back onto the edge: the limit of
/// crossing it to and fro. The block turns along the edge and keeps its speed; gravity acts along the edge, friction
/// with the mean of the two slopes; on its way it goes at most to the end of the edge, and at most a quarter of a cell.
///
/// @param slope   the patch the block is in;  beyond: the patch on the other side of the edge
/// @return        Held where the block rests and friction exceeds gravity along the edge, or has no velocity along a
///                level one
CreaseEnd slide_along_crease(const Slope& slope, const Slope& beyond, Motion& motion, double farthest, Path& path);

}  // namespace talus
