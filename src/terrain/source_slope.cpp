#include "talus/terrain/source_slope.hpp"

#include <cmath>
#include <limits>

#include "talus/base/vector.hpp"

namespace talus {

double horn_slope(const Raster<float>& heights, int column, int row) {
  const Grid& grid = heights.grid;
  if (!grid.contains(column - 1, row - 1) || !grid.contains(column + 1, row + 1))
    return std::numeric_limits<double>::quiet_NaN();
  const auto z = [&](int east, int north) { return static_cast<double>(heights.at(column + east, row + north)); };
  const double to_east = (z(1, 1) + 2.0 * z(1, 0) + z(1, -1)) - (z(-1, 1) + 2.0 * z(-1, 0) + z(-1, -1));
  const double to_north = (z(1, 1) + 2.0 * z(0, 1) + z(-1, 1)) - (z(1, -1) + 2.0 * z(0, -1) + z(-1, -1));
  const double centre = 0.0 * z(0, 0);  // NaN if the cell itself is missing: Horn's formula does not read it
  return std::hypot(to_east / (8.0 * grid.cell_x), to_north / (8.0 * grid.cell_y)) + centre;
}

double default_source_slope(double cell) {
  return radians(55.0 * std::pow(cell, -0.075));
}

}  // namespace talus
