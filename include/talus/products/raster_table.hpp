#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "talus/products/hazard.hpp"
#include "talus/products/hazard_matrix.hpp"
#include "talus/products/maps.hpp"

/// The table of all rasters, one entry each. Values, files, legends, estimates of their size and the check of the docs
/// follow from it. How to add a raster: docs/adding-a-raster.md.
namespace talus {

/// Numbers of trajectories of a run, and the thresholds whose exceedances are counted.
struct RunCounts {
  std::uint64_t released;
  double per_source;  ///< trajectories per source cell
  Thresholds thresholds;
};
RunCounts counts_of(const Scenario& scenario);

/// A cell that a trajectory crosses.
struct TouchedCell {
  const CellRecord& record;
  const std::uint32_t* exceedances;  ///< number for each threshold, quantity by quantity
};

/// Writes one number per band.
using CellRule = std::function<void(const TouchedCell& cell, std::span<double> values)>;

/// A raster of a run.
struct RunRaster {
  Map map;              ///< without values, and without the bands of thresholds
  std::string meaning;  ///< of a value, in the words of docs/products.md
  /// Makes the rule for touched cells.
  std::function<CellRule(const RunCounts& run)> rule;
  /// Value of each band where nothing crosses. If empty: 0 for a probability or a count, nodata for a quantity.
  std::function<std::vector<double>(const RunCounts& run)> untouched{};
  /// The raster has a band for each threshold of this quantity; without thresholds it is not written.
  std::optional<Quantity> thresholds_of{};
  std::string threshold_symbol{};  ///< of the quantity in the names of these bands: "E"
};

const std::vector<RunRaster>& run_rasters();

/// The bands of a raster; empty if it is not written.
std::vector<Map::Band> bands_of(const RunRaster& raster, const RunCounts& run);

/// A place and the matrix: the input of its figures.
struct HazardPlace {
  const HazardCurve& curve;
  const HazardMatrix& matrix;
  bool exit;  ///< paths leave the terrain from here
};

/// A raster of `talus hazard`. If it has `numbers`, one raster is written for each; the number replaces `placeholder`
/// in the texts.
struct HazardRaster {
  Map map;              ///< without values and classes
  std::string meaning;  ///< of a value, in the words of docs/hazard.md
  /// Appends the figures of a place for the raster of number `i`, one per band.
  std::function<void(const HazardPlace& place, std::size_t i, std::vector<float>& figures)> figures;
  std::string placeholder{};  ///< "<kJ>", "<years>"; empty: a single raster
  std::function<std::vector<double>(const HazardRules& rules, const HazardMatrix& matrix)> numbers{};
  bool has_classes = false;  ///< values are classes of the matrix
};

const std::vector<HazardRaster>& hazard_rasters();

/// A map of the hazard of a run, without values.
struct HazardMap {
  const HazardRaster* raster;
  std::size_t i;  ///< index of its number
  Map map;
};

/// The maps of all rasters and numbers, in the order in which they are written.
std::vector<HazardMap> hazard_maps_of(const HazardRules& rules, const HazardMatrix& matrix);

}  // namespace talus
