#pragma once
#include <string>

#include "dataset.hpp"

namespace talus::io {

/// Refuses an ASCII grid (.asc) that does not hold the numbers that its header says, and nothing else. GDAL takes a
/// word that is no number for 0, shifts all numbers after a missing one, and does not look at those that are left over:
/// with too small a number of rows the map lies too far south. Other rasters are not looked at. Throws InputError.
///
/// @param path  as the user named it
void check_text_grid(GDALDataset& dataset, const std::string& path);

}  // namespace talus::io
