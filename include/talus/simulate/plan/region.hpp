#pragma once
#include <cstddef>

#include "talus/terrain/grid.hpp"

namespace talus {

/// Number of cells on a side of a region. The grid is scored in square regions, and source cells are worked off region
/// by region.
inline constexpr int kRegionSide = 64;
inline constexpr int kRegionCells = kRegionSide * kRegionSide;

/// The regions of a grid, numbered row by row from the south-west.
struct Regions {
  int across = 0, up = 0;

  explicit Regions(const Grid& grid)
      : across((grid.columns + kRegionSide - 1) / kRegionSide), up((grid.rows + kRegionSide - 1) / kRegionSide) {}

  std::size_t count() const { return static_cast<std::size_t>(across) * static_cast<std::size_t>(up); }
  /// Number of the region that is `column` regions from the west and `row` regions from the south.
  std::size_t number(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(across) + static_cast<std::size_t>(column);
  }
  /// Number of the region of a cell of the grid.
  std::size_t of_cell(int column, int row) const { return number(column / kRegionSide, row / kRegionSide); }
};

/// Number of a cell of the grid within its region, row by row.
inline std::size_t cell_in_region(int column, int row) {
  return static_cast<std::size_t>(row % kRegionSide * kRegionSide + column % kRegionSide);
}

}  // namespace talus
