#include "talus/products/gap_exits.hpp"

#include "talus/terrain/dem_gaps.hpp"

namespace talus {

void GapExits::add(std::span<const StopRow> rows) {
  const Grid& grid = heights_.grid;
  for (const StopRow& stop : rows) {
    if (stop.end != End::Left) continue;
    const int column = grid.column_of(stop.x), row = grid.row_of(stop.y);
    if (grid.contains(column, row)) ++by_cell_[grid.index(column, row)];
  }
}

std::uint64_t GapExits::blocks() const {
  DemGaps gaps(heights_);
  const auto columns = static_cast<std::size_t>(heights_.grid.columns);
  std::uint64_t sum = 0;
  for (const auto& [cell, blocks] : by_cell_)
    if (gaps.beside(static_cast<int>(cell % columns), static_cast<int>(cell / columns))) sum += blocks;
  return sum;
}

}  // namespace talus
