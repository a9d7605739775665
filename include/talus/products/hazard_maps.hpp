#pragma once
#include <cstdint>
#include <utility>
#include <vector>

#include "talus/products/hazard.hpp"
#include "talus/products/hazard_matrix.hpp"
#include "talus/products/maps.hpp"
#include "talus/products/raster_table.hpp"

namespace talus {

/// The figures of all hazard maps, cell by cell: some tens of numbers for each cell that anything passes.
class HazardSurvey {
 public:
  HazardSurvey(const Grid& grid, HazardRules rules, HazardMatrix matrix);

  /// A touched cell: its column, what was kept.
  using Cell = std::pair<int, HazardCell>;

  /// Evaluates a row, its cells at the same time.
  ///
  /// @param terrain  by column, whether there is any; rows that are not given have none
  /// @param cells    from west to east
  /// @param threads  0: as many as the machine has
  void set_row(int row, std::vector<bool> terrain, std::span<const Cell> cells, int threads = 0);

  const Grid& grid() const { return grid_; }
  const HazardRules& rules() const { return rules_; }
  const HazardMatrix& matrix() const { return matrix_; }
  std::uint64_t cells() const;  ///< that were touched

  /// Numbers `first` and following of each cell of a row: NaN without terrain, those of no passage where it was not
  /// touched.
  void fill(int row, std::size_t first, std::size_t count, std::span<double> values) const;

 private:
  struct Row {
    std::vector<bool> terrain;
    std::vector<int> columns;
    std::vector<float> figures;
  };
  std::vector<float> figures_of(const HazardCell& cell) const;  // as many of every cell

  Grid grid_;
  HazardRules rules_;
  HazardMatrix matrix_;
  std::vector<HazardMap> maps_;  // whose figures a cell has, one after the other
  std::vector<Row> rows_;
  std::vector<float> nothing_;  // figures of a cell that nothing passes
};

/// The maps of `hazard_rasters`, of each energy threshold and of each of the matrix's years. The survey must outlive
/// them.
///
/// NaN: a return period that is infinite, an energy that has no bound, and cells without terrain. What is rarer than
/// the longest return period of the matrix counts in the class, but never makes one undecided: no number of
/// trajectories would show that nothing ever passes.
std::vector<Map> make_hazard_maps(const HazardSurvey& survey);

}  // namespace talus
