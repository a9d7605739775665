#pragma once
#include <memory>
#include <string>
#include <vector>

#include "talus/io/gdal/rasters.hpp"
#include "talus/physics/effects/forest_stems.hpp"
#include "talus/simulate/scenario/parameter_table.hpp"

namespace talus::io {

/// A forest from files.
struct ForestLayer {
  ForestStems forest;  ///< with its map; density: the largest of the cells, or trees per area of the DEM [1/ha]
  std::string note;    ///< of a list of trees: what was read, in one line
  std::vector<Reprojection> reprojections;
  std::vector<std::string> warnings;
};

/// Files of a forest; empty: none. Either trees or rasters.
struct ForestRequest {
  std::string density, diameter;  ///< rasters; where one is empty the number of the effect holds
  std::string trees;              ///< points
};

/// Hint for a diameter that is too large: it may be in centimetres. Empty for other numbers.
std::string centimetres_hint(const Bounds& bounds, double value);

/// Reads a forest onto the grid of the DEM. `numbers` are those of the effect.
///
/// Rasters, of any grid and system: stems per hectare and DBH in m, the value of the pixel that holds the centre of the
/// cell. No forest: cells without a value, or with a density of 0. Trees: points with the fields `diameter` (DBH, m)
/// and, if it is there, `species`. Throws InputError for values out of bounds, an unknown species, or if nothing is
/// left.
ForestLayer read_forest(const ForestRequest& request, const ForestStems& numbers, const Terrain& terrain);

}  // namespace talus::io
