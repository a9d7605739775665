#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>

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

/// How heights between the centres of cells are made. docs/physics.md, "Terrain".
enum class SurfaceKind : std::uint8_t {
  Bilinear,  ///< bilinear patches
  Creased    ///< the same, but two planes where a bilinear patch would dam a thalweg along its diagonal
};
inline constexpr SurfaceKind kDefaultSurface = SurfaceKind::Creased;
inline constexpr std::array<std::string_view, 2> kSurfaceNames{"bilinear", "creased"};
inline std::string_view name_of(SurfaceKind kind) {
  return kSurfaceNames[static_cast<std::size_t>(kind)];
}
/// The kind with this name; empty if there is none.
std::optional<SurfaceKind> surface_kind(std::string_view name);

/// Diagonal of a patch along which it is creased.
enum class Crease : std::uint8_t {
  None,
  Rising,  ///< from the south-western corner to the north-eastern one
  Falling  ///< from the north-western corner to the south-eastern one
};

/// The crease of a patch on a creased surface: the diagonal that holds the lowest corner, if the bilinear patch rises
/// along it from its higher end: a dam between the two ends. Comparisons of heights only, without rounding.
inline Crease crease_of(const Patch& patch) {
  const double se = patch.east, nw = patch.north, ne = se + nw + patch.twist;  // above the south-western corner
  const double rising = se + nw - 2.0 * std::max(0.0, ne);                     // twice the slope at the higher end
  const double falling = ne - 2.0 * std::max(se, nw);
  if (!(std::max(rising, falling) > 0.0)) return Crease::None;
  if (rising > falling) return std::min(0.0, ne) <= std::min(se, nw) ? Crease::Rising : Crease::None;
  return std::min(se, nw) <= std::min(0.0, ne) ? Crease::Falling : Crease::None;
}

/// Position across a crease [patches]: positive north of it, 0 on it.
inline double across(Crease crease, double p, double q) {
  return crease == Crease::Rising ? q - p : p + q - 1.0;
}
/// Its rate, from the rates of p and q.
inline double rate_across(Crease crease, double rate_p, double rate_q) {
  return crease == Crease::Rising ? rate_q - rate_p : rate_p + rate_q;
}
/// Largest distance at which a place counts as on the crease [patches]: far above rounding, far below any effect.
inline constexpr double kOnCrease = 1e-9;

/// The plane north or south of the crease of a patch. It holds the crease and the corner on its side.
inline Patch half_of(const Patch& patch, Crease crease, bool north) {
  const double twist = patch.twist;
  if (crease == Crease::Rising)
    return north ? Patch{patch.corner, patch.east + twist, patch.north, 0.0}
                 : Patch{patch.corner, patch.east, patch.north + twist, 0.0};
  return north ? Patch{patch.corner - twist, patch.east + twist, patch.north + twist, 0.0}
               : Patch{patch.corner, patch.east, patch.north, 0.0};
}

/// Whether a block at (p, q) is on the northern half of a creased patch. On the crease: the half that it moves into;
/// a block that moves along the crease is on the southern half.
inline bool on_northern_half(Crease crease, double p, double q, double rate_p, double rate_q) {
  const double side = across(crease, p, q);
  return std::abs(side) > kOnCrease ? side > 0.0 : rate_across(crease, rate_p, rate_q) > 0.0;
}

/// Index of a patch: its south-western corner is the centre of cell (column, row).
struct PatchIndex {
  int column = 0, row = 0;
  bool operator==(const PatchIndex&) const = default;
};

/// The terrain: one continuous surface over a grid of heights. A patch is bilinear, or two planes if it has a crease.
/// Both have the same straight edges between the centres of cells.
class Surface {
 public:
  /// @param heights  [m]; NaN: missing. A patch with a missing corner is outside the domain.
  explicit Surface(Raster<float> heights, SurfaceKind kind = SurfaceKind::Bilinear)
      : heights_(std::move(heights)), per_cell_x_(1.0 / grid().cell_x), per_cell_y_(1.0 / grid().cell_y), kind_(kind) {}

  SurfaceKind kind() const { return kind_; }
  bool creased() const { return kind_ == SurfaceKind::Creased; }
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

  /// Reads patch `i` as a bilinear one. Returns false if it is outside the grid or has a missing corner.
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

  /// The crease of a patch that was read.
  Crease crease(const Patch& patch) const { return creased() ? crease_of(patch) : Crease::None; }

  /// The patch on which a block meets the ground at (p, q): a bilinear patch, or the half of a creased one. On the
  /// crease it is the half that the block moves into; for a block that moves along the crease, which touches both
  /// halves, the plane between them.
  ///
  /// @param patch     as read
  /// @param velocity  of the block [m/s]
  Patch facet(const Patch& patch, double p, double q, const Vec3& velocity) const {
    const Crease along = crease(patch);
    return along == Crease::None ? patch : facet_of(patch, along, {p, q}, velocity);
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
  Patch facet_of(const Patch& patch, Crease along, const Eigen::Vector2d& place, const Vec3& velocity) const;

  Raster<float> heights_;
  double per_cell_x_, per_cell_y_;
  SurfaceKind kind_;
};

/// Outward unit normal of a surface with this gradient.
inline Vec3 normal_of(const Eigen::Vector2d& gradient) {
  return Vec3(-gradient.x(), -gradient.y(), 1.0) * (1.0 / std::sqrt(1.0 + gradient.squaredNorm()));
}

}  // namespace talus
