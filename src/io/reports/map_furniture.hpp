#pragma once
#include <string>

#include "markup.hpp"
#include "report_maps.hpp"

/// What lies over and beside every map of a page.
namespace talus::io {

inline constexpr double kLegendWidth = 230.0, kLegendGap = 14.0;  ///< of the column beside a map [px]
inline constexpr double kLowestDrawing = 396.0;                   ///< room for the longest legend [px]

/// Words under every map.
struct MapImprint {
  std::string crs, date, attribution;  // date: day of run.json
};

/// The scale of the drawings: places on the map as places in the drawing [px].
struct MapScale {
  double per_metre, width, height, west, north;

  explicit MapScale(const MapSheet& sheet);
  double x(double east) const { return per_metre * (east - west); }
  double y(double northing) const { return per_metre * (north - northing); }
  double drawing_height() const;
};

/// "rgb(195,15,165)".
std::string css_colour(const Colour& colour);
/// A length in a drawing, to a tenth of a pixel.
std::string tenth(double value);
/// Adds an attribute to an open tag; its value is escaped.
Markup& set_attribute(Markup& to, const char* name, const std::string& value);

/// The group `outlines`: source cells, pixels from which paths leave the map, screens, objects, coordinates.
Markup outlines(const MapSheet& sheet, const RunFacts& run, const MapScale& scale);
/// The group `furniture`: key of the outlines, scale bar, arrow to the north, where and when.
Markup furniture(const MapSheet& sheet, const RunFacts& run, const MapImprint& imprint, const MapScale& scale);

}  // namespace talus::io
