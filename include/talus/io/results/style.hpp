#pragma once
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "talus/products/maps.hpp"

namespace talus::io {

/// A class of a legend. Values above the limit of the class before, up to and with its own, belong to it.
struct LegendClass {
  double limit;  ///< infinite in the last class; the value itself where values are classes
  std::string label;
  std::string colour;  ///< "#rrggbb"
};

/// Red, green and blue (0 to 255) of "#rrggbb".
std::array<int, 3> channels_of(const std::string& colour);

/// The classes of a legend, without that of 0. @param to_one  nothing is above the last limit
std::vector<LegendClass> classes_of(const Legend& legend, bool to_one);
/// The classes of a map, by their limits or their names.
std::vector<LegendClass> classes_of(const Map& map);

/// The look of a map in QGIS (3.22 and later): the text of its `.qml`.
///
/// One band in the discrete classes of the map's legend, with its unit. Zero and nodata are transparent. The colours go
/// from light to dark, so that they differ in grey and for the colour-blind. Throws std::logic_error if the map has no
/// legend, or not the band that its legend shows.
std::string style_of(const Map& map);

/// The look of the cells that a band of a map marks: one colour, all others transparent.
std::string style_of(const Map& map, const Map::Mark& mark);
/// Name of the file of that style: "hazard_class_cut_short.qml" of the band `cut short`.
std::string mark_style_name(const std::string& map, std::string band);

/// Writes `NAME.qml` and, if there are names of classes, `NAME.tif.aux.xml` beside the raster, where QGIS and GDAL find
/// them by themselves; of each mark that the raster has in any cell its style, too. Throws std::runtime_error.
void write_style(const std::filesystem::path& folder, const Map& map);

}  // namespace talus::io
