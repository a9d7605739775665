#pragma once
#include <optional>
#include <string>

#include "talus/terrain/grid.hpp"

/// Records of where a run comes from.
namespace talus::io {

/// A parameter as the run used it, for run.json.
struct Setting {
  std::string key;    ///< "ground.zones.road.En50"
  std::string value;  ///< in the units of the file
  std::string unit;   ///< "m3/s2"; empty if there is none
  std::string
      source;  ///< "scenario", "flag --seed", "preset forest-road-3d", "default", "attribute diameter of cliffs.shp"
};

/// Role of the model that a scenario includes: a ground that talus calibrate or diagnose has fitted.
inline constexpr const char* kFittedModel = "include";
/// Beginning of the settings that list which numbers of a ground are of that model.
inline constexpr const char* kFittedNumbers = "fit.zones.";

/// A file that was read.
struct InputFile {
  std::string role;  ///< "dem", "sources", "ground", "screens", "scenario", kFittedModel
  std::string path;  ///< absolute
  std::string
      sha256;  ///< of the bytes of all its files, one after the other (a shapefile: of .shp, .dbf, .shx, .prj, .cpg)
  std::string content = {};  ///< the same without the bytes by which SQLite notes who has opened a file (GeoPackage)
};

/// How a layer in another coordinate system was brought to the DEM's.
struct Reprojection {
  std::string role;
  std::string operation;             ///< PROJ's name of the operation it chose
  std::optional<double> accuracy_m;  ///< nothing: unknown
};

/// Place of the grid on the earth, for the writers.
struct GeoReference {
  std::string crs_wkt;
  double west = 0.0, north = 0.0;     ///< upper-left corner in that system [m]
  double cell_x = 1.0, cell_y = 1.0;  ///< [m], both > 0
};

/// From metres in the grid to map coordinates [m].
struct MapPlace {
  double west, south;  ///< lower-left corner of the grid
  MapPlace(const GeoReference& geo, const Grid& grid) : west(geo.west), south(geo.north - grid.rows * geo.cell_y) {}
  double x(double local) const { return west + local; }
  double y(double local) const { return south + local; }
};

}  // namespace talus::io
