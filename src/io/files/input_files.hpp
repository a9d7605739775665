#pragma once
#include <string>
#include <vector>

namespace talus::io {

/// The files that belong to one input: itself (of a part of a file that file), those that are read with it (the other
/// files of a shapefile or a MapInfo table; header, world file, .prj, mask and .aux.xml of a raster; the log -wal of a
/// GeoPackage), and those that a VRT names, each with its own. Of a folder its files in the order of their names.
/// Overviews (.ovr), which a program that shows a raster may write, are not among them.
std::vector<std::string> files_of_input(const std::string& path);

}  // namespace talus::io
