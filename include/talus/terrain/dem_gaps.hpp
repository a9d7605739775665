#pragma once
#include <cstddef>
#include <unordered_map>

#include "talus/terrain/raster.hpp"

namespace talus {

/// The gaps of a DEM: cells without a height that are not connected with its outer rows and columns by such cells, as a
/// lake or a hole of a laser scan. Cells that touch at a side or a corner are connected. Those connected with the outer
/// rows and columns lie beyond the outline of a clipped DEM.
class DemGaps {
 public:
  /// @param heights  [m]; NaN: missing. It must outlive this.
  explicit DemGaps(const Raster<float>& heights) : heights_(heights) {}

  /// Whether the cell or one of its eight neighbours is in a gap, and none of them beyond the outline or off the grid.
  ///
  /// Searches only the gaps that it meets, by runs of cells of a row, and until the search reaches an outer row or
  /// column. Memory: some 50 bytes for each run that was searched.
  bool beside(int column, int row);

 private:
  /// Cells of a row without a height, from `first` to `last`; the cells before and after have one.
  struct Run {
    int row, first, last;
  };

  bool is_missing(int column, int row) const;
  bool is_outer(const Run& run) const;
  Run run_at(int column, int row) const;
  std::size_t key(const Run& run) const { return heights_.grid.index(run.first, run.row); }
  bool is_enclosed(const Run& run);

  const Raster<float>& heights_;
  std::unordered_map<std::size_t, bool> enclosed_;  // whether a run is in a gap, by its first cell
};

}  // namespace talus
