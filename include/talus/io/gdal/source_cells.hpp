#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "talus/io/gdal/rasters.hpp"

namespace talus::io {

/// The layers of the file of candidate sources.
inline const std::vector<std::string> kSourceLayers{"source_polygons", "source_points"};

/// Summary of the source cells that were found and written.
struct SourceCells {
  std::uint64_t cells = 0, polygons = 0;
  double plan_area = 0.0, true_area = 0.0;  ///< [m2]; true area of a cell = plan area / cos(slope)
  double steepest = 0.0;                    ///< slope of the steepest cell of the DEM, source or not [rad]
};

/// The styles of the two layers in QGIS.
struct SourceStyles {
  std::string polygons, points;
};

/// Writes the cells that are at least as steep as `slope` (`horn_slope`) as candidate sources, in the system of the
/// DEM. `--sources` accepts the GeoPackage unchanged.
///
/// Layer `source_polygons`: connected cells (across sides), with slope_deg (mean), slope_max_deg, area_m2 (true),
/// plan_area_m2, cells. Layer `source_points`: the centre of each cell, row by row from the north-west, with slope_deg,
/// area_m2. If no cell is steep enough, nothing is written.
///
/// @param slope       [rad], 0 to pi/2
/// @param keep_going  called from time to time; if it returns false the writing stops, and the file is worthless
/// Throws std::runtime_error, one line with the file and the cause.
SourceCells write_source_cells(const std::filesystem::path& file, const Terrain& terrain, double slope,
                               const SourceStyles& styles, const std::function<bool()>& keep_going);

}  // namespace talus::io
