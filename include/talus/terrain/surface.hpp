#pragma once
#include <optional>

#include "talus/base/vector.hpp"
#include "talus/terrain/raster.hpp"

namespace talus {

/// One bilinear patch of the terrain, between the centres of four cells:
///
///   z(p, q) = corner + east p + north q + twist p q      p, q in [0, 1] from the centre of the south-western cell
///
/// Height and normal come from this one surface, so that a block is never "inside" the ground. docs/physics.md,
/// "Terrain".
struct Patch {
  double corner = 0.0, east = 0.0, north = 0.0, twist = 0.0;  // [m]

  double height(double p, double q) const { return corner + east * p + north * q + twist * p * q; }
};

/// Index of a patch: its south-western corner is the centre of cell (column, row).
struct PatchIndex {
  int column = 0, row = 0;
  bool operator==(const PatchIndex&) const = default;
};

/// The terrain: one continuous surface of bilinear patches over a grid of heights.
class Surface {
 public:
  /// @param heights  [m]; NaN: missing. A patch with a missing corner is outside the domain.
  explicit Surface(Raster<float> heights)
      : heights_(std::move(heights)), per_cell_x_(1.0 / grid().cell_x), per_cell_y_(1.0 / grid().cell_y) {}

  const Grid& grid() const { return heights_.grid; }
  const Raster<float>& heights() const { return heights_; }

  /// Patch coordinates of a place: u = column + p, v = row + q.
  double u_of(double x) const { return x * per_cell_x_ - 0.5; }
  double v_of(double y) const { return y * per_cell_y_ - 0.5; }
  double x_of(double u) const { return (u + 0.5) * grid().cell_x; }
  double y_of(double v) const { return (v + 0.5) * grid().cell_y; }

  PatchIndex patch_at(double x, double y) const {
    return {static_cast<int>(std::floor(u_of(x))), static_cast<int>(std::floor(v_of(y)))};
  }

  /// Reads patch `i`. Returns false if it is outside the grid or has a missing corner.
  bool read(PatchIndex i, Patch& patch) const {
    if (static_cast<unsigned>(i.column) >= static_cast<unsigned>(grid().columns - 1) ||
        static_cast<unsigned>(i.row) >= static_cast<unsigned>(grid().rows - 1))
      return false;
    const float* south = heights_.values.data() + grid().index(i.column, i.row);
    const float* north = south + grid().columns;
    const double sw = south[0], se = south[1], nw = north[0], ne = north[1];
    patch = {sw, se - sw, nw - sw, (ne - nw) - (se - sw)};
    return !std::isnan(patch.twist);
  }

  /// Height of the surface at a place [m]; empty if there is no surface.
  std::optional<double> height(double x, double y) const;

  /// Patches per metre: multiplied by a speed they give a rate in patch coordinates.
  double per_cell_x() const { return per_cell_x_; }
  double per_cell_y() const { return per_cell_y_; }

  /// Gradient of a patch at (p, q) in it: rise towards east and north [m/m].
  Eigen::Vector2d gradient(const Patch& patch, double p, double q) const {
    return {(patch.east + patch.twist * q) * per_cell_x_, (patch.north + patch.twist * p) * per_cell_y_};
  }

 private:
  Raster<float> heights_;
  double per_cell_x_, per_cell_y_;
};

/// Outward unit normal of a surface with this gradient.
inline Vec3 normal_of(const Eigen::Vector2d& gradient) {
  return Vec3(-gradient.x(), -gradient.y(), 1.0) * (1.0 / std::sqrt(1.0 + gradient.squaredNorm()));
}

}  // namespace talus
