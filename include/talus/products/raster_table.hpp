#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "talus/products/hazard.hpp"
#include "talus/products/hazard_matrix.hpp"
#include "talus/products/maps.hpp"

/// The home of the rasters: one entry each. Values, files, legends, estimates of their size and the check of docs
/// follow from it. How to add one: docs/adding-a-raster.md.
namespace talus {

/// How many trajectories there are, and of what exceedances are counted.
struct RunCounts {
  std::uint64_t released;
  double per_source;  ///< trajectories of a source cell
  Thresholds thresholds;
};
RunCounts counts_of(const Scenario& scenario);

/// A cell that a trajectory crosses.
struct TouchedCell {
  const CellRecord& record;
  const std::uint32_t* exceedances;  ///< of each threshold, quantity by quantity
};

/// Writes one number per band.
using CellRule = std::function<void(const TouchedCell& cell, std::span<double> values)>;

/// A raster of a run.
struct RunRaster {
  Map map;              ///< without values, and without the bands of thresholds
  std::string meaning;  ///< of a value, in the words of docs/products.md
  /// The rule for touched cells.
  std::function<CellRule(const RunCounts& run)> rule;
  /// By band, the value where nothing crosses. Not given: 0 of a probability or a count, nodata of a quantity.
  std::function<std::vector<double>(const RunCounts& run)> untouched{};
  /// Has a band for each threshold of the quantity; without thresholds it is not written.
  std::optional<Quantity> thresholds_of{};
  std::string threshold_symbol{};  ///< of the quantity in the names of these bands: "E"
};

const std::vector<RunRaster>& run_rasters();

/// The bands of a raster; none where it is not written.
std::vector<Map::Band> bands_of(const RunRaster& raster, const RunCounts& run);

/// A place, from which figures follow.
struct HazardPlace {
  const HazardCurve& curve;
  const HazardMatrix& matrix;
};

/// A raster of `talus hazard`. Where it has numbers there is a raster for each, in whose texts the number stands for
/// `placeholder`.
struct HazardRaster {
  Map map;              ///< without values and classes
  std::string meaning;  ///< of a value, in the words of docs/hazard.md
  /// Appends the figures of a place, one per band, of the raster of number `i`.
  std::function<void(const HazardPlace& place, std::size_t i, std::vector<float>& figures)> figures;
  std::string placeholder{};  ///< "<kJ>", "<years>"; empty: a single raster
  std::function<std::vector<double>(const HazardRules& rules, const HazardMatrix& matrix)> numbers{};
  bool has_classes = false;  ///< values are classes of the matrix
};

const std::vector<HazardRaster>& hazard_rasters();

/// A map of the hazard of a run, without values.
struct HazardMap {
  const HazardRaster* raster;
  std::size_t i;  ///< of its number
  Map map;
};

/// The maps of all rasters and numbers, in the order in which they are written.
std::vector<HazardMap> hazard_maps_of(const HazardRules& rules, const HazardMatrix& matrix);

}  // namespace talus
