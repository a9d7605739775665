#pragma once
#include <string>
#include <vector>

namespace talus::io {

/// Whether a name stands for a VRT, a text that names other rasters, on this machine. Nothing else is opened.
bool is_vrt(const std::string& name);

/// If a raster is a VRT, or one lies beside it (dem.tif.ovr, dem.tif.msk), throws InputError unless all that it names,
/// and what these name, are inputs that are allowed: local files below its own folder or below an allowed one, and no
/// Python. Also if an .aux.xml beside any of them names a file.
/// @param name  as GDAL takes it; it is there
/// @param file  the local file behind it
void check_vrt(const std::string& name, const std::string& file);

/// The files that a VRT names, and those that these name, in the order of their names; of a part of a file that file.
/// None if the raster is no VRT and none lies beside it. Takes and throws what `check_vrt` does.
std::vector<std::string> files_of_vrt(const std::string& name, const std::string& file);

}  // namespace talus::io
