#pragma once
#include <string>
#include <vector>

namespace talus::io {

/// The files that belong to one input: of a shapefile .shp, .dbf, .shx and .prj (there or not); of a VRT also the
/// rasters that it is made of; of a folder its files in the order of their names; of everything else the file alone.
std::vector<std::string> files_of_input(const std::string& path);

}  // namespace talus::io
