#pragma once
#include <string>

#include "layer.hpp"

namespace talus::io {

/// Cells of the polygons of a source: blocks start only where a centre is covered, so that a polygon narrower than a
/// cell is left out along parts of its length.
struct PolygonCells {
  std::uint64_t touched = 0, covered = 0;
  /// Touched cells that neither release nor have one of their eight neighbours that does.
  std::uint64_t left_out = 0;

  /// Adds a polygon that covers a centre. Cells at the rim of the grid are never left out: the polygon may go on.
  ///
  /// @param inside, at_all  marks on the cells whose centre it covers, and on those that it touches
  void add(const CellMask& inside, const CellMask& at_all);

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
