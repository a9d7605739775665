#pragma once
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "named_file.hpp"
#include "talus/fit/score/intervals.hpp"
#include "talus/io/gdal/source_fields.hpp"
#include "talus/io/scenario/loaded_scenario.hpp"
#include "talus/simulate/scenario/parameter_table.hpp"

namespace talus::io {

/// A kind of ground as the input describes it.
struct ZoneSpec {
  std::string name;
  std::string preset;
  Ground ground;
  std::map<std::string, std::string> own;  ///< origin of each parameter given beside the preset
  std::string code;                        ///< code of the zone in a raster; empty: its name
  std::vector<Range> intervals{};          ///< of x, on a profile [m]

  /// Whether every number is given beside the preset, as in the complete scenario of a run.
  /// @param unused  numbers that need not be given
  bool gives_all(std::size_t unused = 0) const {
    return own.size() + unused >= ground_fields().size() - 1;  // `shape` is one key of two numbers
  }
};

/// Origin of `ground.default` where the command line gives it.
inline constexpr std::string_view kPresetFlag = "flag --preset";

/// Places where an effect of the input acts, and its maps. Its numbers are in `values`.
struct EffectSpec {
  std::string where;               ///< "scenario.toml:12: [effects.vegetation-drag]", for messages
  std::vector<std::string> zones;  ///< empty: in all
  std::string zones_where;
  NamedFile file;
  std::map<std::string, NamedFile> maps;  ///< by key: rasters in place of numbers; "trees"
};

/// A straight barrier that a scenario or a model names by its ends, in the coordinates of the DEM.
struct BarrierLine {
  std::string id;
  double height = 0.0;    ///< [m]
  double capacity = 0.0;  ///< [J]; infinite if none is given
  Eigen::Vector2d from, to;
  bool says_capacity = true;  ///< whether the file gives one
};

/// Share of the value by which an instrument of a campaign reads too high. It says nothing about the terrain.
struct InstrumentBias {
  std::string where;   ///< "model.toml:12: [[instrument_bias]]", for messages
  std::string screen;  ///< empty: the samples along the paths
  double speed = 0.0, jump = 0.0, spin = 0.0;
};

/// Terrain and places of a profile. The keys that it shares with a scenario are in `ScenarioSpec`.
struct ProfileSpec {
  NamedFile csv, line;  ///< a polyline; or a line over `ScenarioSpec::dem`
  double step = 0.1;    ///< of the columns [m]
  Range source;         ///< x of the releases [m]
  double vx = 0.0, vz = 0.0;
  std::vector<double> screens;  ///< x [m]
  double bin = 5.0;             ///< of the results [m]
};

/// Terrain, blocks and c to which a model was fitted, as far as its file says so. The scenario that a run writes keeps
/// them in [fit].
struct FittedOn {
  NamedFile file;                                           ///< of the model: included, or that of [fit]
  std::string sha256;                                       ///< of the file when it was included
  std::map<std::string, std::vector<std::string>> numbers;  ///< [fit.zones]: keys of each ground, of the model
  std::optional<SurfaceKind> surface;
  std::optional<double> cell;                     ///< side of the cells of the DEM [m]
  std::optional<Range> diameters;                 ///< of the blocks [m]
  std::optional<double> deformation_coefficient;  ///< c of the impact law [-]
  std::optional<Reduction> skill;                 ///< over the climatology; the interval may be unknown
};

/// Content of a scenario file and the flags, before any other file is opened.
struct ScenarioSpec {
  NamedFile scenario, include, dem, sources, ground, screens, barriers;
  SurfaceKind surface = kDefaultSurface;
  FittedOn fitted_on;                    ///< of a model that is included, or was in an earlier run
  std::vector<std::string> vrt_folders;  ///< below which a VRT may name files; where a VRT is named
  std::string zones_where;  ///< "scenario.toml:12": [ground.zones] of the scenario, for messages; empty: it has none
  std::string ground_field;
  ZoneSpec default_ground;
  std::vector<ZoneSpec> zones;                ///< in the order of the file
  std::map<std::string, EffectSpec> effects;  ///< by name
  std::vector<BarrierLine> barrier_lines;
  std::vector<InstrumentBias> instrument_bias;  ///< of a model that is included
  Range release_height = SourceFeature{}.release_height;
  FieldMap source_fields;
  std::optional<ProfileSpec> profile;          ///< of `talus profile`: there are no layers then
  Scenario values;                             ///< its settings; without terrain, sources and screens
  std::vector<std::string> warnings;           ///< about settings that are not what they seem
  std::map<std::string, std::string> origins;  ///< of the keys that are given: "scenario", "flag --seed"

  /// The files that it names, with their roles in run.json: "dem", "effects.forest-stems.density".
  std::vector<std::pair<std::string, const NamedFile*>> inputs() const;
  std::vector<std::pair<std::string, NamedFile*>> inputs();

  std::string origin(const std::string& key) const {
    const auto found = origins.find(key);
    return found == origins.end() ? "default" : found->second;
  }
};

}  // namespace talus::io
