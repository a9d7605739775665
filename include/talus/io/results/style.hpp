#pragma once
#include <filesystem>
#include <string>

#include "talus/products/maps.hpp"

namespace talus::io {

/// The look of a map in QGIS (3.22 and later): the text of its `.qml`.
///
/// One band in the discrete classes of the map's legend, with its unit. Zero and nodata are transparent. The colours go
/// from light to dark, so that they differ in grey and for the colour-blind. Throws std::logic_error if the map has no
/// legend, or not the band that its legend shows.
std::string style_of(const Map& map);

/// Writes `NAME.qml` beside the raster, where QGIS finds it by itself. Throws std::runtime_error.
void write_style(const std::filesystem::path& folder, const Map& map);

}  // namespace talus::io
