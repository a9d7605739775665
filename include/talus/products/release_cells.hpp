#pragma once
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "talus/simulate/scenario/scenario.hpp"

namespace talus {

/// The cells from which blocks are released: the sources as the run took them.
class ReleaseCells {
 public:
  explicit ReleaseCells(const Scenario& scenario);
  /// Writes the number of trajectories released from each cell of a row; nodata where there is neither terrain nor a
  /// release.
  void fill_row(int row, std::span<double> values) const;

 private:
  const Scenario& scenario_;
  std::vector<std::pair<int, int>> cells_;  // row and column of each source cell, ascending
};

}  // namespace talus
