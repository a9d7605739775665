#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "talus/products/maps.hpp"

/// The table of all rasters of a run, one entry each (those of `talus hazard`: hazard_table.hpp). Values, files,
/// legends, estimates of their size and the check of the docs follow from it. How to add a raster:
/// docs/adding-a-raster.md.
namespace talus {

/// Numbers of trajectories of a run, and the thresholds whose exceedances are counted.
struct RunCounts {
  std::uint64_t released;
  double per_source;  ///< trajectories per source cell
  Thresholds thresholds;
  double cell_x = 1.0, cell_y = 1.0;          ///< size of a cell [m]
  double passages_below = 0.0;                ///< only lower passages count in passage densities [m]; 0: at any height
  bool energy_total = false, bounds = false;  ///< the rasters that are written on request
};
RunCounts counts_of(const Scenario& scenario);

/// A cell that a trajectory crosses.
struct TouchedCell {
  const CellRecord& record;
  const std::uint32_t* exceedances;     ///< number for each threshold, quantity by quantity
  const std::int64_t* lengths_above{};  ///< plan length above each energy threshold [CellRecord::kLengthUnit]
  const EnergyTotal* energy_total{};    ///< null if it is not kept
};

/// Writes one number per band.
using CellRule = std::function<void(const TouchedCell& cell, std::span<double> values)>;

/// A raster of a run.
struct RunRaster {
  Map map;              ///< without values; bands of thresholds come after its bands
  std::string meaning;  ///< of a value, in the words of docs/products.md
  /// Makes the rule for touched cells; empty for a raster that the scenario alone gives.
  std::function<CellRule(const RunCounts& run)> rule;
  /// Value of each band where nothing crosses. If empty: 0 for a probability or a count, nodata for a quantity.
  std::function<std::vector<double>(const RunCounts& run)> untouched{};
  /// The raster has a band for each threshold of this quantity; without any band it is not written.
  std::optional<Quantity> thresholds_of{};
  std::string threshold_band{};   ///< name of these bands; <limit> stands for the threshold: "P(E > <limit>)"
  bool counts_lengths = false;    ///< only passages below `RunCounts::passages_below` count
  bool threshold_bounds = false;  ///< two bands with bounds for each band of a threshold come after these
  /// Makes `Map::fill` of a raster that the scenario alone gives.
  std::function<std::function<void(const CellWindow& window, std::span<double> values)>(const Scenario& scenario)>
      of_scenario{};
  bool RunCounts::*request{};  ///< the raster is written only if this is set
};

/// @param with_rotation  exceedances and lengths count the energy with rotation: titles and bands say so
const std::vector<RunRaster>& run_rasters(bool with_rotation = false);

/// The bands of a raster; empty if it is not written.
std::vector<Map::Band> bands_of(const RunRaster& raster, const RunCounts& run);

}  // namespace talus
