#pragma once
#include <string>

#include "dataset.hpp"

namespace talus::io {

/// Refuses some files of which GDAL would read a part as if it were all: an ENVI or PCRaster raster whose values end
/// early (GDAL gives zeros, or whatever is in the memory), a MapInfo layer (.mif) with more rows in its .mid than
/// shapes, a sequence of GeoJSON with a line that cannot be read. Throws InputError.
///
/// @param path      as the user named it
/// @param file      as GDAL names it
/// @param messages  of opening it
void check_complete(GDALDataset& dataset, const std::string& path, const std::string& file, GdalMessages& messages);

}  // namespace talus::io
