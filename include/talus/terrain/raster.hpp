#pragma once
#include <algorithm>
#include <vector>

#include "talus/base/scratch.hpp"
#include "talus/terrain/grid.hpp"

namespace talus {

/// Values on a grid, row 0 in the south. What stands for a missing value is the reader's business (NaN for heights).
template <class T>
struct Raster {
  Grid grid;
  ScratchVector<T> values;

  Raster() = default;
  Raster(const Grid& g, T fill) : grid(g) {
    constexpr std::size_t kPiece = std::size_t{1} << 24U;
    values.reserve(g.cells());
    while (values.size() < g.cells()) {  // piece by piece, so that a map larger than the memory can be made
      values.resize(std::min(g.cells(), values.size() + kPiece), fill);
      scratch::keep_below_limit();
    }
  }
  Raster(const Grid& g, const std::vector<T>& v) : grid(g), values(v.begin(), v.end()) {}

  T& at(int column, int row) { return values[grid.index(column, row)]; }
  const T& at(int column, int row) const { return values[grid.index(column, row)]; }
};

}  // namespace talus
