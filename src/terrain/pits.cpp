#include "talus/terrain/pits.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace talus {

bool dammed(const Raster<float>& heights, int column, int row) {
  const Grid& grid = heights.grid;
  if (column < 1 || row < 1 || column + 1 >= grid.columns || row + 1 >= grid.rows) return false;
  const auto z = [&](int dx, int dy) { return heights.values[grid.index(column + dx, row + dy)]; };
  const float here = z(0, 0);
  if (!(here < z(-1, 0) && here < z(1, 0) && here < z(0, -1) && here < z(0, 1))) return false;
  return z(-1, -1) < here || z(1, -1) < here || z(-1, 1) < here || z(1, 1) < here;
}

double dam_height(const Raster<float>& heights, int column, int row) {
  if (!dammed(heights, column, row)) return 0.0;
  const double sides = std::min(std::min(heights.at(column - 1, row), heights.at(column + 1, row)),
                                std::min(heights.at(column, row - 1), heights.at(column, row + 1)));
  return sides - heights.at(column, row);
}

DamCount count_dammed(const Raster<float>& heights, const std::function<bool(int column, int row)>& counts) {
  DamCount count;
  for_each_row(heights, [&](int row) {
    for (int column = 0; column < heights.grid.columns; ++column) {
      if (std::isnan(heights.values[heights.grid.index(column, row)])) continue;
      ++count.cells;
      if (dammed(heights, column, row) && (!counts || counts(column, row))) ++count.dammed;
    }
  });
  return count;
}

double pit_depth(const Raster<float>& heights, int column, int row) {
  const Grid& grid = heights.grid;
  if (column < 1 || row < 1 || column + 1 >= grid.columns || row + 1 >= grid.rows) return 0.0;
  const float here = heights.at(column, row);
  double lowest = std::numeric_limits<double>::infinity();
  for (int j = row - 1; j <= row + 1; ++j)
    for (int i = column - 1; i <= column + 1; ++i) {
      if (i == column && j == row) continue;
      const float neighbour = heights.at(i, j);
      if (!(neighbour > here)) return 0.0;  // not higher, or without a height
      lowest = std::min<double>(lowest, neighbour);
    }
  return lowest - here;
}

PitSummary summary_of_pits(const Raster<float>& heights) {
  PitSummary pits;
  for (int row = 0; row < heights.grid.rows; ++row)
    for (int column = 0; column < heights.grid.columns; ++column) {
      const double depth = pit_depth(heights, column, row);
      pits.count += depth > 0.0 ? 1U : 0U;
      pits.deepest = std::max(pits.deepest, depth);
    }
  return pits;
}

}  // namespace talus
