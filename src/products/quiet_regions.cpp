#include "talus/products/quiet_regions.hpp"

#include <algorithm>

namespace talus {

Quiet quiet_of(std::size_t terrain, const CellWindow& window) {
  return terrain == window.cells() ? Quiet::Terrain : terrain == 0 ? Quiet::NoTerrain : Quiet::No;
}

QuietRegions::QuietRegions(const Grid& grid,
                           const std::function<Quiet(std::size_t region, const CellWindow& window)>& look)
    : layout_(grid) {
  for (int row = 0; row < grid.rows; row += kRegionSide)
    for (int column = 0; column < grid.columns; column += kRegionSide)
      regions_.push_back(look(regions_.size(), {column, row, std::min(kRegionSide, grid.columns - column),
                                                std::min(kRegionSide, grid.rows - row)}));
}

Quiet QuietRegions::of(const CellWindow& window) const {
  const int west = window.column / kRegionSide, east = (window.column + window.columns - 1) / kRegionSide;
  const int south = window.row / kRegionSide, north = (window.row + window.rows - 1) / kRegionSide;
  const Quiet first = regions_[layout_.number(west, south)];
  for (int row = south; row <= north; ++row)
    for (int column = west; column <= east; ++column)
      if (regions_[layout_.number(column, row)] != first) return Quiet::No;
  return first;
}

}  // namespace talus
