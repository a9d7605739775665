#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>

#include "talus/base/lane.hpp"
#include "talus/base/vector.hpp"
#include "talus/terrain/raster.hpp"

namespace talus {

/// One bilinear patch of the terrain, between the centres of four cells:
///
///   z(p, q) = corner + east p + north q + twist p q      p, q in [0, 1] from the centre of the south-western cell
///
/// Height and normal come from this one surface, so that a block is never "inside" the ground. docs/physics.md,
/// "Terrain".
template <class Number>
struct BasicPatch {
  Number corner = 0.0, east = 0.0, north = 0.0, twist = 0.0;  // [m]

  [[gnu::always_inline]] Number height(Number p, Number q) const {
    return corner + east * p + north * q + twist * p * q;
  }
};
using Patch = BasicPatch<double>;

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

/// Patches that have a crease, and along which diagonal.
template <class Number>
struct Creases {
  MaskOf<Number> rising, falling;

  [[gnu::always_inline]] MaskOf<Number> there() const { return rising | falling; }
};

/// The crease of a patch on a creased surface: the diagonal that holds the lowest corner, if the bilinear patch rises
/// along it from its higher end: a dam between the two ends. Comparisons of heights only, without rounding.
template <class Number>
[[gnu::always_inline]] inline Creases<Number> creases_of(const BasicPatch<Number>& patch) {
  const Number se = patch.east, nw = patch.north, ne = se + nw + patch.twist;  // above the south-western corner
  const Number rising = se + nw - 2.0 * larger(Number(0.0), ne);               // twice the slope at the higher end
  const Number falling = ne - 2.0 * larger(se, nw);
  const MaskOf<Number> dam = larger(rising, falling) > 0.0;
  if (!any(dam)) return {dam, dam};
  const Number on_rising = smaller(Number(0.0), ne), on_falling = smaller(se, nw);  // the lowest corner of each
  const MaskOf<Number> steeper = rising > falling;
  const MaskOf<Number> along_rising = dam & steeper & (on_rising <= on_falling);
  const MaskOf<Number> along_falling = dam & opposite(steeper) & (on_falling <= on_rising);
  return {along_rising, along_falling};
}
inline Crease crease_of(const Patch& patch) {
  const Creases<double> creases = creases_of(patch);
  return creases.rising ? Crease::Rising : creases.falling ? Crease::Falling : Crease::None;
}

/// Position across a crease [patches]: positive north of it, 0 on it.
template <class Number>
[[gnu::always_inline]] inline Number across(MaskOf<Number> rising, Number p, Number q) {
  return choose(rising, q - p, p + q - 1.0);
}
inline double across(Crease crease, double p, double q) {
  return across<double>(crease == Crease::Rising, p, q);
}
/// Its rate, from the rates of p and q.
template <class Number>
[[gnu::always_inline]] inline Number rate_across(MaskOf<Number> rising, Number rate_p, Number rate_q) {
  return choose(rising, rate_q - rate_p, rate_p + rate_q);
}
inline double rate_across(Crease crease, double rate_p, double rate_q) {
  return rate_across<double>(crease == Crease::Rising, rate_p, rate_q);
}
/// Largest distance at which a place counts as on the crease [patches]: far above rounding, far below any effect.
inline constexpr double kOnCrease = 1e-9;

/// The plane north or south of the crease of a patch. It holds the crease and the corner on its side.
template <class Number>
[[gnu::always_inline]] inline BasicPatch<Number> half_of(const BasicPatch<Number>& patch, MaskOf<Number> rising,
                                                         MaskOf<Number> north) {
  const MaskOf<Number> over_falling = north & opposite(rising), under_rising = rising & opposite(north);
  const MaskOf<Number> turned = over_falling | under_rising;
  return {choose(over_falling, patch.corner - patch.twist, patch.corner),
          choose(north, patch.east + patch.twist, patch.east), choose(turned, patch.north + patch.twist, patch.north),
          Number(0.0)};
}
inline Patch half_of(const Patch& patch, Crease crease, bool north) {
  return half_of<double>(patch, crease == Crease::Rising, north);
}

/// Whether a block at (p, q) is on the northern half of a creased patch. On the crease: the half that it moves into;
/// a block that moves along the crease is on the southern half.
template <class Number>
[[gnu::always_inline]] inline MaskOf<Number> on_northern_half(MaskOf<Number> rising, Number p, Number q, Number rate_p,
                                                              Number rate_q) {
  const Number side = across<Number>(rising, p, q);
  const MaskOf<Number> beside = magnitude(side) > kOnCrease;
  const MaskOf<Number> on_it = opposite(beside), north_of_it = side > 0.0;
  const MaskOf<Number> moves_north = rate_across<Number>(rising, rate_p, rate_q) > 0.0;
  return (beside & north_of_it) | (on_it & moves_north);
}
inline bool on_northern_half(Crease crease, double p, double q, double rate_p, double rate_q) {
  return on_northern_half<double>(crease == Crease::Rising, p, q, rate_p, rate_q);
}

inline constexpr double kAlongCrease = 1e-9;  // share of the speed across it below which a block moves along a crease

/// The plane on which a block meets a creased patch: the half on which it is, on the crease the half that it moves
/// into; along the crease, the plane that holds it, with the mean of the slopes of both halves.
template <class Number>
[[gnu::always_inline]] inline BasicPatch<Number> facet_of(const BasicPatch<Number>& patch, MaskOf<Number> rising,
                                                          Number p, Number q, Number rate_p, Number rate_q) {
  const BasicPatch<Number> half =
      half_of<Number>(patch, rising, on_northern_half<Number>(rising, p, q, rate_p, rate_q));
  const Number speed = magnitude(rate_p) + magnitude(rate_q);
  const MaskOf<Number> along = (magnitude(across<Number>(rising, p, q)) <= kOnCrease) &
                               (magnitude(rate_across<Number>(rising, rate_p, rate_q)) <= kAlongCrease * speed);
  if (!any(along)) return half;
  const MaskOf<Number> every = along | opposite(along);
  const BasicPatch<Number> south = half_of<Number>(patch, rising, opposite(every)),
                           north = half_of<Number>(patch, rising, every);
  return {choose(along, 0.5 * (south.corner + north.corner), half.corner),
          choose(along, 0.5 * (south.east + north.east), half.east),
          choose(along, 0.5 * (south.north + north.north), half.north), Number(0.0)};
}

/// Index of a patch: its south-western corner is the centre of cell (column, row).
struct PatchIndex {
  int column = 0, row = 0;
  bool operator==(const PatchIndex&) const = default;
};

/// Patch coordinate of a place [m].
template <class Number>
[[gnu::always_inline]] inline Number patch_coordinate(Number place, double per_cell) {
  return place * per_cell - 0.5;
}

/// The terrain: one continuous surface over a grid of heights. A patch is bilinear, or two planes if it has a crease.
/// Both have the same straight edges between the centres of cells.
class Surface {
 public:
  /// @param heights  [m]; NaN: missing. A patch with a missing corner is outside the domain.
  explicit Surface(Raster<float> heights, SurfaceKind kind = kDefaultSurface)
      : heights_(std::move(heights)),
        per_cell_x_(1.0 / grid().cell_x),
        per_cell_y_(1.0 / grid().cell_y),
        patch_columns_(static_cast<unsigned>(std::max(1, grid().columns) - 1)),
        patch_rows_(static_cast<unsigned>(std::max(1, grid().rows) - 1)),
        kind_(kind) {}

  SurfaceKind kind() const { return kind_; }
  bool creased() const { return kind_ == SurfaceKind::Creased; }
  const Grid& grid() const { return heights_.grid; }
  const Raster<float>& heights() const { return heights_; }

  /// Patch coordinates of a place: u = column + p, v = row + q.
  double u_of(double x) const { return patch_coordinate(x, per_cell_x_); }
  double v_of(double y) const { return patch_coordinate(y, per_cell_y_); }
  double x_of(double u) const { return (u + 0.5) * grid().cell_x; }
  double y_of(double v) const { return (v + 0.5) * grid().cell_y; }

  PatchIndex patch_at(double x, double y) const {
    return {static_cast<int>(std::floor(u_of(x))), static_cast<int>(std::floor(v_of(y)))};
  }

  /// Reads patch `i` as a bilinear one. Returns false if it is outside the grid or has a missing corner.
  bool read(PatchIndex i, Patch& patch) const {
    if (static_cast<unsigned>(i.column) >= patch_columns_ || static_cast<unsigned>(i.row) >= patch_rows_) return false;
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
  unsigned patch_columns_, patch_rows_;  // number of patches
  SurfaceKind kind_;
};

/// Outward unit normal of a surface that rises by `east` and `north` [m/m].
template <class Number>
[[gnu::always_inline]] inline VectorOf<Number> normal_of(Number east, Number north) {
  return VectorOf<Number>(-east, -north, 1.0) * (1.0 / root(1.0 + (east * east + north * north)));
}
inline Vec3 normal_of(const Eigen::Vector2d& gradient) {
  return normal_of(gradient.x(), gradient.y());
}

}  // namespace talus
