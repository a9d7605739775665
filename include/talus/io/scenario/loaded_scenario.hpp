#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "talus/simulate/scenario/scenario.hpp"

namespace talus::io {

/// A parameter as the run used it, for run.json.
struct Setting {
  std::string key;    ///< "ground.zones.road.En50"
  std::string value;  ///< in the units of the file
  std::string unit;   ///< "m3/s2"; empty if there is none
  std::string
      source;  ///< "scenario", "flag --seed", "preset forest-road-3d", "default", "attribute diameter of cliffs.shp"
};

/// A file that was read.
struct InputFile {
  std::string role;  ///< "dem", "sources", "ground", "screens", "scenario"
  std::string path;  ///< absolute
  std::string
      sha256;  ///< of the file's bytes (a shapefile: of .shp, .dbf, .shx, .prj in this order, one after the other)
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

struct ScenarioSpec;

/// A scenario with the record of its origin.
struct LoadedScenario {
  Scenario scenario;
  GeoReference geo;
  std::string complete_toml;  ///< every setting written out, paths absolute: becomes OUT/scenario.toml
  std::vector<Setting> settings;
  std::vector<InputFile> inputs;
  std::vector<Reprojection> reprojections;
  std::vector<std::string> warnings;         ///< one line each
  std::shared_ptr<const ScenarioSpec> spec;  ///< content of the file and the flags; null for a profile
};

/// Settings of the command line. They override a scenario file or replace it.
struct RunFlags {
  std::string scenario;  ///< path of the TOML file; empty: from flags alone
  std::optional<std::string> dem, sources, preset, surface;
  std::optional<double> diameter;  ///< [m]
  std::optional<std::uint32_t> trajectories;
  std::optional<std::uint64_t> seed;
};

/// Reads and checks everything. Throws InputError, one line; `all_faults` gets every fault of the settings (for
/// `check`).
///
/// @param memory  for the rasters
LoadedScenario load_scenario(const RunFlags& flags, std::vector<std::string>* all_faults = nullptr,
                             const RasterMemory& memory = {});

/// Multiplies the trajectories by the number of rounds. Leaves `settings` as they are.
void set_rounds(LoadedScenario& loaded, std::uint32_t rounds);

}  // namespace talus::io
