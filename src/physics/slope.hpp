#pragma once
#include <cmath>
#include <optional>

#include "talus/physics/slide.hpp"

namespace talus {

/// The smooth piece of the surface on which a block slides: a bilinear patch, or one half of a creased patch.
struct Facet {
  PatchIndex at;
  bool north = false;  ///< of the crease; false if there is none
  bool operator==(const Facet&) const = default;
};

/// Largest distance from the border of two cells at which a block counts as on it [patches].
inline constexpr double kOnBorder = 1e-9;

/// Whether a place is in the far half of a patch, or of an edge of it. In the middle is the border of two cells: there
/// it is the half that a block moves into.
///
/// @param share  of the patch or edge, 0..1
/// @param ahead  above 0 if the block moves towards the far half, 0 if it does not move across the border
inline bool in_far_half(double share, double ahead) {
  return std::abs(share - 0.5) > kOnBorder || ahead == 0.0 ? share >= 0.5 : ahead > 0.0;
}

/// A quarter of a patch: the part of one of the four cells whose centres are its corners.
struct Quarter {
  bool east = false, north = false;
};

/// A facet in metres, with its friction.
struct Slope {
  const Surface& surface;
  PatchIndex at;
  double tan_phi;
  Patch patch{}, whole{};  ///< of the facet; of the patch that it is a part of
  Crease crease = Crease::None;
  bool north = false;
  std::optional<Quarter> bounded_to{};  ///< the cell at whose border a slide stops, since friction changes there

  /// Reads the facet. Returns false if there is none.
  bool read(const Facet& facet) {
    at = facet.at;
    if (!surface.read(at, whole)) return false;
    crease = surface.crease(whole);
    north = crease != Crease::None && facet.north;
    patch = crease == Crease::None ? whole : half_of(whole, crease, north);
    return true;
  }
  /// Reads the facet of patch `at` that a block enters at `place` with velocity `v`. Returns false if there is none.
  bool read(const Eigen::Vector2d& place, const Eigen::Vector2d& v) {
    if (!surface.read(at, whole)) return false;
    crease = surface.crease(whole);
    return read(Facet{
        at, crease != Crease::None && on_northern_half(crease, p_of(place), q_of(place), v.x() * surface.per_cell_x(),
                                                       v.y() * surface.per_cell_y())});
  }
  /// Which facet it is.
  Facet index() const { return {at, north}; }
  /// The facet of this patch that holds a place; this one if the place is on the crease.
  Facet facet_at(const Eigen::Vector2d& place) const {
    const double side = crease == Crease::None ? 0.0 : across(crease, p_of(place), q_of(place));
    return {at, std::abs(side) > kOnCrease ? side > 0.0 : north};
  }

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
  /// Acceleration by which the surface presses the block, upwards [m/s^2]. Negative if the ground falls away below the
  /// free parabola.
  double press(const Eigen::Vector2d& v) const { return kGravity + 2.0 * twist() * v.x() * v.y(); }
};

/// Velocity along the surface from a velocity in plan.
inline Vec3 along(const Eigen::Vector2d& v, const Eigen::Vector2d& gradient) {
  return {v.x(), v.y(), v.dot(gradient)};
}

inline constexpr double kLongestPiece = 1.0;  // of sliding [s]

/// Adds a piece of sliding to the path: a vertex and a span. A piece that takes no time adds nothing.
void record_piece(Path& path, const Slope& slope, const Motion& before, const Motion& after);

/// Time in which a block of speed `s` and acceleration `a` covers a distance [s]; at most `longest`.
double time_to_cover(double distance, double s, double a, double longest);

}  // namespace talus
