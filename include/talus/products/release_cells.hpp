#pragma once
#include <span>
#include <utility>
#include <vector>

#include "talus/products/cell_window.hpp"
#include "talus/simulate/scenario/scenario.hpp"

namespace talus {

/// The cells from which blocks are released: the sources as the run took them.
class ReleaseCells {
 public:
  explicit ReleaseCells(const Scenario& scenario);
  /// Writes the number of trajectories released from each cell of a window, row by row; nodata where there is neither
  /// terrain nor a release.
  void fill(const CellWindow& window, std::span<double> values) const;

 private:
  void fill_row(int first, int row, std::span<double> values) const;

  const Scenario& scenario_;
  std::vector<std::pair<int, int>> cells_;  // row and column of each source cell, ascending
};

}  // namespace talus
