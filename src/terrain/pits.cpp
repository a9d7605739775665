#include "talus/terrain/pits.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace talus {

namespace {

/// The same as `dammed` of a cell with eight neighbours. No branch for each of the sides: few of them can be foretold.
bool dammed_inside(const float* z, std::ptrdiff_t row) {
  const float here = *z;
  const bool below_its_sides = static_cast<int>(here < z[-1]) & static_cast<int>(here < z[1]) &
                               static_cast<int>(here < z[-row]) & static_cast<int>(here < z[row]);
  return below_its_sides && (z[-row - 1] < here || z[-row + 1] < here || z[row - 1] < here || z[row + 1] < here);
}

bool is_inside(const Grid& grid, int column, int row) {
  return column >= 1 && row >= 1 && column + 1 < grid.columns && row + 1 < grid.rows;
}

}  // namespace

bool dammed(const Raster<float>& heights, int column, int row) {
  const Grid& grid = heights.grid;
  return is_inside(grid, column, row) && dammed_inside(&heights.at(column, row), grid.columns);
}

double dam_height(const Raster<float>& heights, int column, int row) {
  if (!dammed(heights, column, row)) return 0.0;
  const double sides = std::min(std::min(heights.at(column - 1, row), heights.at(column + 1, row)),
                                std::min(heights.at(column, row - 1), heights.at(column, row + 1)));
  return sides - heights.at(column, row);
}

DamCount count_dammed(const Raster<float>& heights, const std::function<bool(int column, int row)>& counts) {
  const Grid& grid = heights.grid;
  DamCount count;
  for_each_row(heights, [&](int row) {
    const float* z = &heights.at(0, row);
    for (int column = 0; column < grid.columns; ++column) count.cells += std::isnan(z[column]) ? 0U : 1U;
    if (row < 1 || row + 1 >= grid.rows) return;
    for (int column = 1; column + 1 < grid.columns; ++column)
      if (dammed_inside(z + column, grid.columns) && (!counts || counts(column, row))) ++count.dammed;
  });
  return count;
}

double pit_depth(const Raster<float>& heights, int column, int row) {
  if (!is_inside(heights.grid, column, row)) return 0.0;
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
