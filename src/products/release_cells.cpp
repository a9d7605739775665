#include "talus/products/release_cells.hpp"

#include <algorithm>
#include <cmath>

namespace talus {

ReleaseCells::ReleaseCells(const Scenario& scenario) : scenario_(scenario) {
  const Grid& grid = scenario.surface.grid();
  cells_.reserve(scenario.sources.size());
  for (const SourceCell& source : scenario.sources)
    cells_.emplace_back(std::clamp(grid.row_of(source.y), 0, grid.rows - 1),
                        std::clamp(grid.column_of(source.x), 0, grid.columns - 1));
  std::ranges::sort(cells_);
}

void ReleaseCells::fill_row(int row, std::span<double> values) const {
  for (std::size_t column = 0; column < values.size(); ++column)
    values[column] = std::isnan(scenario_.surface.heights().at(static_cast<int>(column), row)) ? kNotGiven : 0.0;
  for (auto cell = std::ranges::lower_bound(cells_, std::pair{row, 0}); cell != cells_.end() && cell->first == row;
       ++cell) {
    double& value = values[static_cast<std::size_t>(cell->second)];
    value = (std::isnan(value) ? 0.0 : value) + scenario_.trajectories;
  }
}

}  // namespace talus
