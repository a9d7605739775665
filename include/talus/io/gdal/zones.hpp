#pragma once
#include <string>
#include <vector>

#include "talus/io/gdal/rasters.hpp"

namespace talus::io {

/// Kinds of ground from a file.
struct ZoneLayer {
  Raster<std::uint8_t> zones;        ///< 0: the default ground; i + 1: names[i] of the request
  std::string field;                 ///< field of the polygons that named the zone; empty for a raster
  std::vector<std::string> presets;  ///< those of the request that the map names: zones names.size() + 1 and on
  std::vector<Reprojection> reprojections;
  std::vector<std::string> notes;  ///< which fields were read
  std::vector<std::string> warnings;
};

/// File of the kinds of ground, and how to read it.
struct ZoneRequest {
  std::string path;
  std::string field;                   ///< of polygons; empty: "zone". Not for rasters
  std::vector<std::string> names;      ///< names of the described zones in the file; at most 255
  std::vector<std::string> codes{};    ///< code of each zone in a raster; empty, or an empty text: its name
  std::string default_code{};          ///< code in a raster of the ground outside all zones; "default" is one too
  std::vector<std::string> presets{};  ///< further names that a zone may have on the map
  std::string table = "ground.zones";  ///< table that describes the zones, for messages
};

/// Reads the kinds of ground onto the grid of the DEM: the ground of a cell is the one at its centre.
///
/// Raster, of any grid and system: whole numbers, the value of the pixel that holds the centre of the cell. Polygons: a
/// text or whole-number field; later features lie over earlier ones. Cells without a value or polygon: zone 0.
/// Throws InputError for a zone on the map that is not described; warns of one that is described and not on the map.
ZoneLayer read_zones(const ZoneRequest& request, const Terrain& terrain);

}  // namespace talus::io
