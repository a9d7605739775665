#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "talus/io/origin/origin.hpp"

namespace talus::io {

/// "EPSG:31287 (MGI / Austria Lambert)"; the name alone if it has no code.
std::string crs_name(const std::string& wkt);

/// The warning that the layer or raster `path` states no coordinate system and is read in that of the DEM.
std::string dem_system_note(const std::string& path, const std::string& dem_wkt);

/// A rectangle in a coordinate system [m].
struct MapExtent {
  double west, south, east, north;
};

/// "east 0 to 300, north 0 to 300.5".
std::string extent_text(const MapExtent& extent);

/// A rectangle and its system.
struct MapArea {
  MapExtent extent;
  std::string wkt;
};

/// Whether places have the same coordinates in both systems: height systems and the order of the axes do not count.
bool same_plane_system(const std::string& wkt, const std::string& other_wkt);

/// Layer that is transformed, for the record and for messages.
struct LayerName {
  std::string role;  ///< "sources"
  std::string path;
};

/// Checks that the coordinate system of the raster `path` is a plane one in metres, with heights in metres if it states
/// their unit. Otherwise throws InputError with the way out. Local systems (engineering CRS) in metres are accepted.
///
/// @return a warning if the map projection stretches distances by more than 1 % at the middle of the extent (more than
/// 5 %, as Web Mercator does, is refused); nothing otherwise
std::optional<std::string> check_metric(const std::string& path, const std::string& wkt, const MapExtent& extent);

/// Transforms places from one coordinate system into another by PROJ; does nothing if both are the same. Local grids
/// (engineering CRS) with the same axes and units are taken as the same, as nothing ties them to the earth.
class Transformer {
 public:
  /// @param map  area for which PROJ chooses the best operation
  /// Throws InputError if there is no operation from one to the other.
  Transformer(LayerName layer, const std::string& from_wkt, const std::string& to_wkt, const MapArea& map);
  ~Transformer();
  Transformer(Transformer&&) noexcept;

  /// x east, y north (or longitude, latitude), whatever the order of the axes in the system.
  /// Throws InputError "`where`: the place ..." where it cannot be transformed.
  void apply(double& x, double& y, const std::string& where);

  /// The operations that were used so far, looked up at one place in 256, with their accuracy. Empty for the identity.
  const std::vector<Reprojection>& used() const;

  /// One line for every operation whose accuracy is unknown or worse than half a cell, and one if two local grids with
  /// different names are taken as the same.
  std::vector<std::string> warnings(double cell) const;

 private:
  struct Projection;
  std::unique_ptr<Projection> projection_;
};

}  // namespace talus::io
