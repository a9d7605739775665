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

void ReleaseCells::fill(const CellWindow& window, std::span<double> values) const {
  scenario_.surface.heights().values.memory().keep_below_limit();
  for (int row = 0; row < window.rows; ++row)
    fill_row(window.column, window.row + row,
             values.subspan(static_cast<std::size_t>(row) * static_cast<std::size_t>(window.columns),
                            static_cast<std::size_t>(window.columns)));
}

void ReleaseCells::fill_row(int first, int row, std::span<double> values) const {
  const int end = first + static_cast<int>(values.size());
  for (int column = first; column < end; ++column)
    values[static_cast<std::size_t>(column - first)] =
        std::isnan(scenario_.surface.heights().at(column, row)) ? kNotGiven : 0.0;
  for (auto cell = std::ranges::lower_bound(cells_, std::pair{row, first});
       cell != cells_.end() && *cell < std::pair{row, end}; ++cell) {
    double& value = values[static_cast<std::size_t>(cell->second - first)];
    value = (std::isnan(value) ? 0.0 : value) + scenario_.trajectories;
  }
}

}  // namespace talus
