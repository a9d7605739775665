#pragma once
#include <cstddef>

namespace talus {

/// A rectangle of cells of a grid. Row 0 is the southern one, as in `Grid`.
struct CellWindow {
  int column = 0, row = 0;  ///< of its south-western cell
  int columns = 0, rows = 0;

  std::size_t cells() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
};

}  // namespace talus
