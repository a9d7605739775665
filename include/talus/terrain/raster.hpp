#pragma once
#include <utility>
#include <vector>

#include "talus/terrain/grid.hpp"

namespace talus {

/// Values on a grid, row 0 in the south. What stands for a missing value is the reader's business (NaN for heights).
template <class T>
struct Raster {
  Grid grid;
  std::vector<T> values;

  Raster() = default;
  Raster(const Grid& g, T fill) : grid(g), values(g.cells(), fill) {}
  Raster(const Grid& g, std::vector<T> v) : grid(g), values(std::move(v)) {}

  T& at(int column, int row) { return values[grid.index(column, row)]; }
  const T& at(int column, int row) const { return values[grid.index(column, row)]; }
};

}  // namespace talus
