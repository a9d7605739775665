#include "talus/terrain/steep_gully.hpp"

#include <array>
#include <cmath>
#include <utility>

#include "talus/terrain/source_slope.hpp"

namespace talus {
namespace {

/// Whether the ground rises more steeply than `tan_phi` to both sides of a cell, along a row, a column or a diagonal.
bool between_walls(const Raster<float>& heights, int column, int row, double tan_phi) {
  const Grid& grid = heights.grid;
  if (!grid.contains(column - 1, row - 1) || !grid.contains(column + 1, row + 1)) return false;
  const auto rise = [&](int east, int north) {
    return double{heights.at(column + east, row + north)} - heights.at(column, row);
  };
  constexpr std::array<std::pair<int, int>, 4> kAxes{{{1, 0}, {0, 1}, {1, 1}, {1, -1}}};
  for (const auto& [east, north] : kAxes) {
    const double wall = tan_phi * std::hypot(east * grid.cell_x, north * grid.cell_y);
    if (rise(east, north) > wall && rise(-east, -north) > wall) return true;
  }
  return false;
}

}  // namespace

bool in_steep_gully(const Raster<float>& heights, int column, int row, double tan_phi) {
  const auto steep = [&](int i, int j) { return horn_slope(heights, i, j) > tan_phi; };
  if (!steep(column, row)) return false;
  for (int j = row - 1; j <= row + 1; ++j)
    for (int i = column - 1; i <= column + 1; ++i)
      if (between_walls(heights, i, j, tan_phi) && steep(i, j)) return true;
  return false;
}

}  // namespace talus
