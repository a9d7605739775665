#pragma once
#include <string>
#include <vector>

#include "talus/io/gdal/rasters.hpp"

namespace talus::io {

/// Places of release from a vector file.
struct SourceLayer {
  std::vector<SourceFeature> features;  ///< in the order of the file, with those wholly off the map
  std::vector<SourceCell> cells;        ///< by feature: its cells row by row from the north-west, then its points
  std::vector<std::int64_t> ids;        ///< of the features in the file, for messages
  std::vector<Setting> attributes;      ///< settings read from the fields
  std::vector<Reprojection> reprojections;
  std::vector<std::string> warnings;
};

/// Reads sources: polygons, lines, points, mixed or in collections, in any coordinate system.
///
/// A polygon gives the cells whose centres it covers; if it covers none, the cells that it touches. A line gives the
/// cells that it crosses, a point its place. A feature of several parts gives the cells of each part, but each cell
/// once. Cells without terrain are left out (with a warning). These fields are read if they are there, in upper or
/// lower case: frequency, diameter, diameter_min, diameter_max, height, vx, vy, vz, name; NULL counts as not given.
///
/// @param release_height  for features without the field height [m]
/// Throws InputError that names file, feature, field, value and what is allowed; also if no cell is left.
SourceLayer read_sources(const std::string& path, const Terrain& terrain, const Range& release_height);

/// Screens (lines whose crossings are recorded) from a vector file.
struct ScreenLayer {
  std::vector<Screen> screens;
  std::vector<Reprojection> reprojections;
  std::vector<std::string> warnings;
};

/// Reads screens: lines with a field `id` (text or whole number; else the number of the feature). Lines of the same id,
/// and the parts of a multiline, are one screen. A plain CSV with columns id,wkt is in the system of the DEM.
ScreenLayer read_screens(const std::string& path, const Terrain& terrain);

/// Barriers from a vector file.
struct BarrierLayer {
  std::vector<Barrier> barriers;
  std::vector<Reprojection> reprojections;
  std::vector<std::string> warnings;
};

/// Reads barriers: lines with the fields `height` [m] and `capacity` [kJ], which must be there, and `id` as for
/// screens. Each feature is one barrier.
BarrierLayer read_barriers(const std::string& path, const Terrain& terrain);

}  // namespace talus::io
