#pragma once
#include <string>
#include <vector>

#include "talus/io/gdal/rasters.hpp"
#include "talus/io/gdal/source_fields.hpp"
#include "talus/simulate/scenario/scenario.hpp"

namespace talus::io {

/// In a warning about a source with a frequency of which a part releases nothing: off the DEM, where it has no heights,
/// or narrower than a cell.
inline constexpr const char* kAllOnTheRest = " events per year all fall on the ";
/// In a warning about sources with a frequency that release nothing.
inline constexpr const char* kEventsLost = " events per year are lost";

/// Whether a warning of `read_sources` says that a source, or a part of one, releases nothing.
bool is_of_cut_sources(const std::string& warning);

/// Places of release from a vector file.
struct SourceLayer {
  std::vector<SourceFeature> features;  ///< in the order of the file, with those wholly off the map
  std::vector<SourceCell> cells;        ///< by feature: its cells row by row from the north-west, then its points
  std::vector<std::string> fields;      ///< names of all fields of the layer
  std::vector<Setting> attributes;      ///< settings read from the fields
  std::vector<Reprojection> reprojections;
  std::string read_note;                  ///< which fields were read, with the range of their values
  std::vector<std::string> unread_notes;  ///< fields, and heights, that look as if they were meant, and are not read
  std::vector<std::string> warnings;
  bool unread_height = false;  ///< there is a field height, which is not read: it is mostly that of a cliff
};

/// Reads sources: polygons, lines, points, mixed or in collections, in any coordinate system.
///
/// A polygon gives the cells whose centres it covers; if it covers none, the cells that it touches. If it is narrower
/// than a cell in places, a warning counts what is left out. A line gives the cells that it crosses, a point its place.
/// A feature of several parts gives the cells of each part, but each cell once. Cells without terrain are left out
/// (with a warning). These fields are read if they are there, in upper or lower case: frequency, diameter,
/// diameter_min, diameter_max, release_height, vx, vy, vz, name; NULL counts as not given; numbers may stand in text
/// fields. A feature without a name has its number (FID) for one.
///
/// @param release_height  for features without the field release_height [m]
/// Throws InputError that names file, feature, field, value and what is allowed; also if no cell is left.
SourceLayer read_sources(const std::string& path, const Terrain& terrain, const Range& release_height,
                         const FieldMap& fields = {});

}  // namespace talus::io
