#pragma once
#include <string>

#include "talus/io/gdal/rasters.hpp"

namespace talus::io {

/// Reads the first band of a DEM into `terrain.heights`, whose grid is that of the file: metres, NaN where there is
/// none.
///
/// Each thread opens the file for itself and reads pieces of it. Throws InputError if a piece cannot be read, if a
/// height is outside [-500, 9000] m, or if there is no height at all: that of the first such piece, for any number of
/// threads.
void read_heights(const std::string& path, Terrain& terrain, int threads);

}  // namespace talus::io
