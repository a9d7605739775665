#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/gdal/picture.hpp"

namespace talus::io {

/// A class of a map: the values up to `limit`, which belongs to it.
struct MapClass {
  double limit = 0.0;
  std::string label;
  Colour colour;  ///< opacity 0: not drawn
};

/// How QGIS draws a raster: the style beside it.
struct MapStyle {
  int band = 1;
  bool exact = false;  ///< a class is one value, not a range
  std::vector<MapClass> classes;

  /// The index of the class of a value; nothing for NaN and for values of no class.
  std::optional<std::size_t> class_of(double value) const;
};

/// Reads a `.qml` with discrete classes or single values, as talus writes it. Nothing if there is none, or none of this
/// kind.
std::optional<MapStyle> read_map_style(const std::filesystem::path& file);

}  // namespace talus::io
