#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>

#include "talus/io/gdal/rasters.hpp"

namespace talus::io {

/// What was found and written.
struct SourceCells {
  std::uint64_t cells = 0, polygons = 0;
  double plan_area = 0.0, true_area = 0.0;  ///< [m2]; of a cell, its area in plan / cos(slope)
  double steepest = 0.0;                    ///< slope of the steepest cell of all, also where none is a source [rad]
};

/// Writes the cells that are at least so steep (`horn_slope`) as candidate sources, in the system of the DEM: a
/// GeoPackage that `--sources` takes as it is.
///
/// Layer `source_polygons`: connected cells (across sides), with slope_deg (mean), slope_max_deg, area_m2 (true),
/// plan_area_m2, cells. Layer `source_points`: the centre of each cell, row by row from the north-west, with slope_deg,
/// area_m2. Where no cell is steep enough nothing is written.
///
/// @param slope       [rad], 0 to pi/2
/// @param keep_going  asked now and then; false: stops, the file is then worthless
/// Throws std::runtime_error, one line with the file and the cause.
SourceCells write_source_cells(const std::filesystem::path& file, const Terrain& terrain, double slope,
                               const std::function<bool()>& keep_going);

}  // namespace talus::io
