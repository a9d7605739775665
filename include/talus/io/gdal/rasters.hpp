#pragma once
#include <string>
#include <vector>

#include "talus/io/gdal/crs.hpp"
#include "talus/terrain/raster.hpp"

namespace talus::io {

/// The terrain of a file.
struct Terrain {
  Raster<float> heights;  ///< [m], NaN where there is none
  GeoReference geo;
  std::vector<std::string> warnings;

  MapExtent extent() const;  ///< in the system of the file
  MapArea map() const { return {extent(), geo.crs_wkt}; }
};

/// Reads the first band of a DEM: anything GDAL reads, north-up, in a projected system in metres.
///
/// Missing (NaN): nodata value, mask, alpha, NaN, infinity. Scale and offset of the band are applied. Throws
/// InputError if it is rotated, upside down, without place or system, in degrees or feet, has less than 2 x 2 cells or
/// none with a height, or holds heights outside [-500, 9000] m that are not declared as missing.
///
/// @param threads  that read pieces of the file at once; heights and messages do not depend on it
Terrain read_terrain(const std::string& path, const RasterMemory& memory = {}, int threads = 1);

}  // namespace talus::io
