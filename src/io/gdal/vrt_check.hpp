#pragma once
#include <string>

namespace talus::io {

/// If a raster is a VRT (a text that names other rasters), throws InputError unless all that it names, and what these
/// name, are inputs that are allowed: local files below its own folder or below an allowed one, and no Python.
/// @param name  as GDAL takes it; it is there
/// @param file  the local file behind it
void check_vrt(const std::string& name, const std::string& file);

}  // namespace talus::io
