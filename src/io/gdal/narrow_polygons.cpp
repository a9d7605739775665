#include "narrow_polygons.hpp"

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
      covered += inside.marks[at] != 0 ? 1U : 0U;
      // The window is wider than the polygon, so that its rim is touched only at the rim of the grid.
      const bool at_rim = row == 0 || column == 0 || row + 1 == at_all.rows || column + 1 == at_all.columns;
      left_out += at_rim || marked_near(inside, at) ? 0U : 1U;
    }
}

bool PolygonCells::is_narrow() const {
  constexpr std::uint64_t kMostAtCorners = 4;
  constexpr double kNoticed = 0.01;
  return left_out > kMostAtCorners && static_cast<double>(left_out) > kNoticed * static_cast<double>(touched);
}

std::string left_out_text(const PolygonCells& cells) {
  return "of the " + std::to_string(cells.touched) + " cells that it touches, " + std::to_string(cells.left_out) +
         " release nothing, nor does a neighbour of them";
}

}  // namespace talus::io
