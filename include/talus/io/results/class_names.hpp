#pragma once
#include <string>

#include "talus/products/maps.hpp"

namespace talus::io {

/// The names of a map's classes as GDAL stores them beside a raster: category names and a raster attribute table with
/// the colours. Empty if the legend does not ask for it (`Legend::names_in_file`).
std::string class_names_of(const Map& map);

}  // namespace talus::io
