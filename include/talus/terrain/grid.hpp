#pragma once
#include <cmath>
#include <cstddef>

namespace talus {

/// A regular north-up grid of cells: the only place that converts between cells and metres.
///
/// Local coordinates are metres east and north of the grid's lower-left (south-west) corner. Column 0 is the western,
/// row 0 the SOUTHERN one (files have the northern row first; `io` reverses the rows when it reads and writes).
struct Grid {
  int columns = 0, rows = 0;
  double cell_x = 1.0, cell_y = 1.0;  ///< width and height of a cell [m], > 0
  double west = 0.0, south = 0.0;     ///< the lower-left corner in the coordinate system of the file [m]

  std::size_t cells() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
  double width() const { return columns * cell_x; }
  double height() const { return rows * cell_y; }

  int column_of(double x) const { return static_cast<int>(std::floor(x / cell_x)); }
  int row_of(double y) const { return static_cast<int>(std::floor(y / cell_y)); }
  bool contains(int column, int row) const { return column >= 0 && column < columns && row >= 0 && row < rows; }
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
  }
  double centre_x(int column) const { return (column + 0.5) * cell_x; }
  double centre_y(int row) const { return (row + 0.5) * cell_y; }

  bool operator==(const Grid&) const = default;
};

}  // namespace talus
