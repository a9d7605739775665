#pragma once
#include <string>

#include "dataset.hpp"

namespace talus::io {

/// Refuses an ASCII grid (.asc) that has more or fewer numbers than its header says, or a word among them. GDAL takes a
/// word that is no number for 0, shifts all numbers after a missing one, and does not look at those that are left over:
/// with too small a number of rows the map lies too far south. Of a VRT all rasters are looked at, also those that may
/// be cut off (`check_complete`). Throws InputError.
///
/// @param path  as the user named it
void check_text_grid(GDALDataset& dataset, const std::string& path);

}  // namespace talus::io
