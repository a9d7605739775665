#pragma once
#include <filesystem>
#include <string>

#include "talus/products/maps.hpp"

namespace talus::io {

/// The look of a map in QGIS (3.22 and later): the text of its `.qml`.
///
/// One band in discrete classes, shown with its unit: of energy, velocity and jump height the P95; of a probability
/// powers of ten; of an energy the classes between 30, 100, 300, 1000 and 3000 kJ. Zero and nodata are transparent. The
/// colours go from light to dark, so that they are told apart in grey and by the colour-blind.
std::string style_of(const Map& map);

/// Writes `NAME.qml` beside the raster, where QGIS finds it by itself. Throws std::runtime_error.
void write_style(const std::filesystem::path& folder, const Map& map);

}  // namespace talus::io
