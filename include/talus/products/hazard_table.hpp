#pragma once
#include <functional>
#include <string>
#include <vector>

#include "talus/products/hazard.hpp"
#include "talus/products/hazard_matrix.hpp"
#include "talus/products/maps.hpp"
#include "talus/products/object_width.hpp"

/// The table of all rasters of `talus hazard`, one entry each, as `raster_table.hpp` is of a run.
namespace talus {

/// A place and the matrix: the input of its figures.
struct HazardPlace {
  const HazardRules& rules;
  const HazardMatrix& matrix;
  bool exit = false;                   ///< paths leave the terrain from here
  std::vector<Bounded> levels;         ///< how often: passage, then each energy threshold [1/year]
  const HazardCurve* curve = nullptr;  ///< over all energies; null for an object of some width

  /// Frequency of exceeding an energy [kJ]; without a curve, of a threshold.
  Bounded exceedance_of(double energy) const;
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
  bool needs_curve = false;  ///< there is none for an object of some width
  /// If given: one raster with a band for each of these energies, <kJ> in its name; only on request.
  std::function<std::vector<double>(const HazardRules& rules, const ObjectWidth& object)> band_energies{};
};

/// @param with_rotation  energies count the rotation: titles and bands say so
const std::vector<HazardRaster>& hazard_rasters(bool with_rotation = false);

/// A map of the hazard of a run, without values.
struct HazardMap {
  const HazardRaster* raster;
  std::size_t i;  ///< index of its number
  Map map;
};

/// The energies of the bands of `hazard_curves` [kJ]: of an object of some width only 0 and the thresholds are known.
std::vector<double> energies_of_curves(const HazardRules& rules, const ObjectWidth& object);

/// The maps of all rasters and numbers, in the order in which they are written. @param curves  hazard curves too
std::vector<HazardMap> hazard_maps_of(const HazardRules& rules, const HazardMatrix& matrix,
                                      const ObjectWidth& object = {}, bool curves = false);

}  // namespace talus
