#include "narrow_polygons.hpp"

#include <algorithm>

namespace talus::io {
namespace {

/// Whether a cell within the window or one of its neighbours, which are there, is marked.
bool marked_near(const CellMask& mask, std::size_t at) {
  const auto columns = static_cast<std::size_t>(mask.columns);
  for (const std::size_t row : {at - columns, at, at + columns})
    for (const std::size_t cell : {row - 1, row, row + 1})
      if (mask.marks[cell] != 0) return true;
  return false;
}

}  // namespace

void PolygonCells::add(const CellMask& inside, const CellMask& at_all) {
  std::size_t at = 0;
  for (int row = 0; row < at_all.rows; ++row)
    for (int column = 0; column < at_all.columns; ++column, ++at) {
      if (at_all.marks[at] == 0) continue;
      ++touched;
      // The window is wider than the polygon, so that its rim is touched only at the rim of the grid.
      const bool at_rim = row == 0 || column == 0 || row + 1 == at_all.rows || column + 1 == at_all.columns;
      if (!at_rim && !marked_near(inside, at)) left_out.push_back({at_all.column + column, at_all.north_row - row});
    }
}

void PolygonCells::keep_far_from(std::span<const Cell> released) {
  std::erase_if(left_out, [&](const Cell& cell) {
    for (int row = cell.row - 1; row <= cell.row + 1; ++row)
      for (int column = cell.column - 1; column <= cell.column + 1; ++column)
        if (std::ranges::binary_search(released, Cell{column, row}, from_north_west)) return true;
    return false;
  });
}

bool PolygonCells::is_narrow() const {
  constexpr std::uint64_t kMostAtCorners = 4;
  constexpr double kNoticed = 0.01;
  const std::size_t count = left_out.size();
  return count > kMostAtCorners && static_cast<double>(count) > kNoticed * static_cast<double>(touched);
}

std::string left_out_text(const PolygonCells& cells) {
  return "of the " + std::to_string(cells.touched) + " cells that it touches, " +
         std::to_string(cells.left_out.size()) + " release nothing, nor does a neighbour of them";
}

}  // namespace talus::io
