#pragma once
#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "talus/products/hazard.hpp"
#include "talus/products/hazard_matrix.hpp"
#include "talus/products/hazard_table.hpp"
#include "talus/products/maps.hpp"
#include "talus/products/object_width.hpp"
#include "talus/products/quiet_regions.hpp"

namespace talus {

/// The values (figures) of all hazard maps: some tens of numbers for each touched cell.
///
/// Either the object is the cell; or it has a width: then the passages of a disc of this diameter around the centre of
/// each cell count, and `finish` must be called after the last row.
class HazardSurvey {
 public:
  /// @param curves  frequencies by energy too: some twenty more numbers for each touched cell
  HazardSurvey(const Grid& grid, HazardRules rules, HazardMatrix matrix, const ObjectWidth& object = {},
               bool curves = false);

  /// Evaluates the cells of a row in parallel.
  ///
  /// @param terrain  by column, whether there is terrain; rows that are never set have none
  /// @param cells    from west to east
  /// @param threads  0: as many as the machine has
  void set_row(int row, std::vector<bool> terrain, std::span<const HazardAt> cells, int threads = 0);

  /// Evaluates the places of an object of some width; nothing else. @param threads  0: as many as the machine has
  void finish(int threads = 0);

  const Grid& grid() const { return grid_; }
  const ObjectWidth& object() const { return object_; }
  bool curves() const { return curves_; }
  const HazardRules& rules() const { return rules_; }
  const HazardMatrix& matrix() const { return matrix_; }
  std::uint64_t cells() const;  ///< number of touched cells, or of places where an object is hit

  /// Fills figures `first` to `first + count - 1` of each cell of a window: NaN without terrain; untouched cells have
  /// the figures of no passage.
  void fill(const CellWindow& window, std::size_t first, std::size_t count, std::span<double> values) const;
  /// What the cells of a window have in common; looks at each.
  Quiet quiet(const CellWindow& window) const;
  /// The same figures of cells where nothing happens; nothing for `Quiet::No`.
  std::optional<std::vector<double>> everywhere(Quiet quiet, std::size_t first, std::size_t count) const;

 private:
  struct Row {
    std::vector<bool> terrain;
    std::vector<int> columns;
    std::vector<float> figures;
    std::vector<PassageDensity> densities;  // by cell and level, until `finish`
    std::vector<bool> exits;                // by cell, until `finish`: paths leave the terrain from here

    bool has_terrain(int column) const {
      return static_cast<std::size_t>(column) < terrain.size() && terrain[static_cast<std::size_t>(column)];
    }
    /// Index of the first touched cell in this column or east of it.
    std::size_t first_from(int column) const {
      return static_cast<std::size_t>(std::ranges::lower_bound(columns, column) - columns.begin());
    }
  };
  std::vector<float> figures_of(const HazardAt& at) const;  // the same number for every cell
  std::vector<float> figures_of(std::span<const PassageDensity> levels, bool exit) const;
  std::vector<float> figures_of(const HazardPlace& place) const;
  Row averaged(int row, std::span<const DiscCell> disc) const;

  Grid grid_;
  HazardRules rules_;
  HazardMatrix matrix_;
  ObjectWidth object_;
  bool curves_;
  double seen_;                  // width of the place over which densities are averaged [m]
  std::vector<HazardMap> maps_;  // in the order of the figures of a cell
  std::vector<Row> rows_;
  std::vector<float> nothing_;  // figures of a cell that nothing passes
};

/// The maps of `hazard_rasters`, for each energy threshold and each of the matrix's years. The survey must outlive
/// them.
///
/// NaN: an infinite return period, an energy without a bound, a cell without terrain. Events rarer than the longest
/// return period of the matrix count in the class, but never make it undecided: no number of trajectories would show
/// that nothing ever passes.
std::vector<Map> make_hazard_maps(const HazardSurvey& survey);

}  // namespace talus
