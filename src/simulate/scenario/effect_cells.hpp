#pragma once
#include <cmath>
#include <vector>

#include "talus/simulate/scenario/scenario.hpp"

namespace talus {

/// The cells in which an effect acts: those of its area; of forest-stems those of them with a stand, or with trees.
class EffectCells {
 public:
  EffectCells(const EffectEntry& entry, const Scenario& scenario)
      : scenario_(scenario),
        area_(entry.area(scenario.effects)),
        forest_(entry.mapped ? &scenario.effects.forest_stems : nullptr) {
    if (forest_ == nullptr || !forest_->lists_trees()) return;
    const Grid& grid = scenario.surface.grid();
    trees_.resize(grid.cells());
    for (const Tree& tree : forest_->map->trees.trees())
      trees_[grid.index(grid.column_of(tree.place.x()), grid.row_of(tree.place.y()))] = true;
  }

  bool has(int column, int row) const {
    const Grid& grid = scenario_.surface.grid();
    if (!trees_.empty()) return trees_[grid.index(column, row)];
    const double x = grid.centre_x(column), y = grid.centre_y(row);
    const std::uint8_t zone = scenario_.cover.zone_at(x, y);
    return forest_ != nullptr ? has_stand(*forest_, zone, x, y) : area_ == nullptr || area_->covers(zone, x, y);
  }

  /// Calls visit(column, row) for each of them that has a height.
  template <class Visit>
  void for_each(Visit visit) const {
    const Raster<float>& heights = scenario_.surface.heights();
    for_each_row(heights, [&](int row) {
      for (int column = 0; column < heights.grid.columns; ++column)
        if (!std::isnan(heights.at(column, row)) && has(column, row)) visit(column, row);
    });
  }

 private:
  const Scenario& scenario_;
  const EffectArea* area_;
  const ForestStems* forest_;  // null: another effect
  std::vector<bool> trees_;    // per cell: whether a tree of the list stands there; empty without a list
};

}  // namespace talus
