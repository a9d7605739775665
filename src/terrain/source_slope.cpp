#include "talus/terrain/source_slope.hpp"

#include <cmath>

#include "talus/base/bounds.hpp"
#include "talus/base/vector.hpp"

namespace talus {
namespace {

/// Horn's formula. @param z  height of the neighbour that many cells to the east and to the north [m]
template <class Height>
double horn(const Grid& grid, Height z) {
  const double to_east = (z(1, 1) + 2.0 * z(1, 0) + z(1, -1)) - (z(-1, 1) + 2.0 * z(-1, 0) + z(-1, -1));
  const double to_north = (z(1, 1) + 2.0 * z(0, 1) + z(-1, 1)) - (z(1, -1) + 2.0 * z(0, -1) + z(-1, -1));
  return std::hypot(to_east / (8.0 * grid.cell_x), to_north / (8.0 * grid.cell_y));
}

}  // namespace

double horn_slope(const Raster<float>& heights, int column, int row) {
  const Grid& grid = heights.grid;
  if (!grid.contains(column - 1, row - 1) || !grid.contains(column + 1, row + 1)) return kNotGiven;
  const auto z = [&](int east, int north) { return static_cast<double>(heights.at(column + east, row + north)); };
  const double centre = 0.0 * z(0, 0);  // NaN if the cell itself is missing: Horn's formula does not read it
  return horn(grid, z) + centre;
}

double true_area(const Grid& grid, double tangent) {
  return grid.cell_x * grid.cell_y * std::sqrt(1.0 + tangent * tangent);  // 1 / cos(slope)
}

double true_area(const Raster<float>& heights, int column, int row) {
  const Grid& grid = heights.grid;
  const auto given = [&](int east, int north) {
    return grid.contains(column + east, row + north) ? double{heights.at(column + east, row + north)} : kNotGiven;
  };
  const double here = given(0, 0);
  const auto side = [&](int east, int north) {
    const double z = given(east, north), opposite = given(-east, -north);
    return !std::isnan(z) ? z : !std::isnan(opposite) ? 2.0 * here - opposite : here;
  };
  const auto continued = [&](int east, int north) {
    if (east == 0 || north == 0) return side(east, north);
    const double z = given(east, north);
    return std::isnan(z) ? side(east, 0) + side(0, north) - here : z;
  };
  return true_area(grid, horn(grid, continued));
}

double default_source_slope(double cell) {
  return radians(55.0 * std::pow(cell, -0.075));
}

}  // namespace talus
