#pragma once
#include <span>
#include <string>
#include <vector>

#include "layer.hpp"

namespace talus::io {

/// A cell of the DEM; row 0 is in the south.
struct Cell {
  int column, row;
  bool operator==(const Cell&) const = default;
};

/// The order of the cells of a source: row by row from the north-west.
inline bool from_north_west(const Cell& a, const Cell& b) {
  return a.row != b.row ? a.row > b.row : a.column < b.column;
}

/// Cells of the polygons of a source: blocks start only where a centre is covered, so that a polygon narrower than a
/// cell is left out along parts of its length.
struct PolygonCells {
  std::uint64_t touched = 0;
  std::vector<Cell> left_out;  ///< touched cells that neither release nor have one of their eight neighbours that does

  /// Adds a polygon that covers a centre. Cells at the rim of the grid are never left out: the polygon may go on.
  ///
  /// @param inside, at_all  marks on the cells whose centre it covers, and on those that it touches
  void add(const CellMask& inside, const CellMask& at_all);
  /// Takes out those near a cell of another part of the feature. @param released  of all parts, from the north-west
  void keep_far_from(std::span<const Cell> released);

  /// Whether so many are left out that a length of the polygon, not a corner, is: five cells and more than 1 %.
  ///
  /// A polygon that is as wide as the diagonal of a cell has none: each of its points lies in a disc of that diameter
  /// within the polygon, and the centre of the cell that holds the middle of the disc lies in the disc. A corner of 30
  /// degrees is as wide 2.6 cells from its tip, and has at most three.
  bool is_narrow() const;
};

/// "of the 101 cells that it touches, 39 release nothing, nor does a neighbour of them".
std::string left_out_text(const PolygonCells& cells);

}  // namespace talus::io
