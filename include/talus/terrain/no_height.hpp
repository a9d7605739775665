#pragma once
#include <span>
#include <vector>

#include "talus/base/vector.hpp"
#include "talus/terrain/raster.hpp"

namespace talus {

/// Share without a height from which a place is warned of: below it, a line that ends at the edge of the DEM.
inline constexpr double kNoticedWithoutHeight = 0.01;

/// Whether blocks get nowhere on a place. @param without  share of it without a height
inline bool is_all_without_height(double without) {
  return !(without < 1.0);
}
/// Whether blocks do not get to a part of it that is worth a warning.
inline bool is_partly_without_height(double without) {
  return without >= kNoticedWithoutHeight && !is_all_without_height(without);
}

/// Whether the terrain has a height at a place (`Surface::height` has one): not in a gap of the DEM, not beside one,
/// not in its outer half cell and not off it. Blocks get nowhere else.
bool has_height(const Raster<float>& heights, const Eigen::Vector2d& place);

/// Length or area, and how much of it lies where the terrain has no height.
struct WithoutHeight {
  double whole = 0.0, without = 0.0;

  double share() const { return whole > 0.0 ? without / whole : 0.0; }
};

/// Adds the length of a line, sampled every half cell. A line without length adds nothing.
void add_line(WithoutHeight& sum, const Raster<float>& heights, std::span<const Eigen::Vector2d> line);

/// Adds the area of a polygon (its outer ring, then its holes), sampled every half cell: at least 16 and at most 256
/// rows of samples.
void add_polygon(WithoutHeight& sum, const Raster<float>& heights, std::span<const std::vector<Eigen::Vector2d>> rings);

}  // namespace talus
