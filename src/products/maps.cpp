#include "talus/products/maps.hpp"

#include <algorithm>
#include <cmath>

#include "talus/products/raster_table.hpp"

namespace talus {
namespace {

/// Fills the rows of a map: a rule for touched cells, and by band the value where nothing crosses.
struct Filling {
  CellRule rule;
  std::vector<double> untouched;
};

std::vector<double> untouched_values(const RunRaster& raster, const RunCounts& run, std::size_t bands) {
  if (raster.untouched) return raster.untouched(run);
  return std::vector<double>(bands, raster.map.kind == Map::Kind::Quantity ? kNotGiven : 0.0);
}

auto rows_of(const Scenario& scenario, const Tally& tally, Filling filling) {
  return [&scenario, &tally, filling = std::move(filling)](int row, std::span<double> values) {
    const Grid& grid = tally.grid();
    const auto columns = static_cast<std::size_t>(grid.columns);
    std::vector<double> cell(filling.untouched.size());
    for (int column = 0; column < grid.columns; ++column) {
      if (column % kRegionSide == 0) tally.memory().keep_below_limit();  // reading a record loads its neighbours too
      const CellRecord* record = tally.find(column, row);
      const bool terrain = !std::isnan(scenario.surface.heights().at(column, row));
      if (record != nullptr)
        filling.rule({*record, tally.exceedances(column, row), tally.lengths_above(column, row),
                      tally.energy_total(column, row)},
                     cell);
      else if (terrain)
        std::ranges::copy(filling.untouched, cell.begin());
      else
        std::ranges::fill(cell, kNotGiven);
      for (std::size_t band = 0; band < cell.size(); ++band)
        values[band * columns + static_cast<std::size_t>(column)] = cell[band];
    }
  };
}

}  // namespace

std::vector<Map> make_maps(const Scenario& scenario, const Tally& tally) {
  RunCounts run = counts_of(scenario);
  run.thresholds = tally.thresholds();
  std::vector<Map> maps;
  for (const RunRaster& raster : run_rasters()) {
    Map map = raster.map;
    map.bands = bands_of(raster, run);
    if (map.bands.empty()) continue;
    if (raster.of_scenario)
      map.fill_row = raster.of_scenario(scenario);
    else
      map.fill_row = rows_of(scenario, tally, {raster.rule(run), untouched_values(raster, run, map.bands.size())});
    maps.push_back(std::move(map));
  }
  return maps;
}

}  // namespace talus
