#pragma once
#include <string>
#include <vector>

namespace talus::io {

/// The files that belong to one input: of a shapefile .shp, .dbf, .shx and .prj, of a VRT also the rasters that it is
/// made of, of a folder its files in the order of their names; else the file itself.
std::vector<std::string> files_of_input(const std::string& path);

}  // namespace talus::io
