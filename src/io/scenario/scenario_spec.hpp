#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "talus/io/scenario/loaded_scenario.hpp"

namespace talus::io {

/// A file that the input names.
struct NamedFile {
  std::string path;   ///< absolute; empty: none
  std::string where;  ///< "scenario.toml:3: dem = 'dem.tif'" or "flag --dem = 'dem.tif'", for messages
};

/// A kind of ground as the input describes it.
struct ZoneSpec {
  std::string name;
  std::string preset;
  Ground ground;
  std::map<std::string, std::string> own;  ///< origin of each parameter given beside the preset
  std::string code;                        ///< code of the zone in a raster; empty: its name
  std::vector<Range> intervals{};          ///< of x, on a profile [m]
};

/// Places where an effect of the input acts. Its numbers are in `values`.
struct EffectSpec {
  std::string where;               ///< "scenario.toml:12: [effects.vegetation-drag]", for messages
  std::vector<std::string> zones;  ///< empty: in all
  std::string zones_where;
  NamedFile file;
};

/// A straight barrier that a scenario or a model names by its ends, in the coordinates of the DEM.
struct BarrierLine {
  std::string id;
  double height = 0.0;    ///< [m]
  double capacity = 0.0;  ///< [J]; infinite if none is given
  Eigen::Vector2d from, to;
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

/// Content of a scenario file and the flags, before any other file is opened.
struct ScenarioSpec {
  NamedFile scenario, include, dem, sources, ground, screens, barriers;
  std::string ground_field;
  ZoneSpec default_ground;
  std::vector<ZoneSpec> zones;                ///< in the order of the file
  std::map<std::string, EffectSpec> effects;  ///< by name
  std::vector<BarrierLine> barrier_lines;
  std::vector<InstrumentBias> instrument_bias;  ///< of a model that is included
  Range release_height = SourceFeature{}.release_height;
  std::optional<ProfileSpec> profile;          ///< of `talus profile`: there are no layers then
  Scenario values;                             ///< its settings; without terrain, sources and screens
  std::map<std::string, std::string> origins;  ///< of the keys that are given: "scenario", "flag --seed"

  std::string origin(const std::string& key) const {
    const auto found = origins.find(key);
    return found == origins.end() ? "default" : found->second;
  }
};

/// Reads the scenario file, if one is given, and overrides it with the flags. Faults of single settings are collected.
/// A fault that ends the reading (no such file, no TOML) is thrown as InputError.
ScenarioSpec read_spec(const RunFlags& flags, std::vector<std::string>& faults);

/// Reads the file of a profile as `read_spec` reads a scenario; `profile` of the result is set.
ScenarioSpec read_profile_spec(const RunFlags& flags, std::vector<std::string>& faults);

class TableReader;
/// Reads the keys that a scenario and a profile share: seed, trajectories, day, [blocks], [model], [effects].
void read_common_keys(ScenarioSpec& spec, TableReader& top, std::vector<std::string>& faults);

/// Puts faults in the order of the lines of the file that they are in; those without a line first.
void sort_by_line(std::vector<std::string>& faults, const std::string& file);
/// Adds a fault for each file that is named and not there.
void check_files(const std::vector<const NamedFile*>& files, std::vector<std::string>& faults);

/// Reads what a scenario may include, and a model for a campaign: [ground] default, [ground.zones.*], the impact law in
/// [model], [effects.*], `line` of [barriers], [[instrument_bias]]. Any other key is a fault.
///
/// @param name    of the file in messages
/// @param origin  for the record: "include fitted.toml"
void read_model_keys(ScenarioSpec& spec, const std::string& path, const std::string& name, const std::string& origin,
                     std::vector<std::string>& faults);

/// The absolute path of a file given relative to `base`. Names that are no files (PG:..., WFS:...) stay as they are,
/// for GDAL.
std::string absolute_path(const std::string& given, const std::filesystem::path& base);

/// Sets the default ground to the preset of the flag, else to the default preset.
void start_with_preset(ScenarioSpec& spec, const RunFlags& flags, std::vector<std::string>& faults);
/// Overrides the scenario file with the other flags.
void lay_flags(ScenarioSpec& spec, const RunFlags& flags, std::vector<std::string>& faults);

/// Adds a warning if the blocks of a scenario have other sizes than those that the presets of its ground were fitted
/// to. A ground whose theta_scale and En50 are both given beside the preset is the user's own.
void warn_of_sizes(const ScenarioSpec& spec, const Scenario& scenario, std::vector<std::string>& warnings);

/// A key or text as TOML writes it.
std::string toml_key(const std::string& name);
std::string toml_text(const std::string& text);

/// The text of a scenario file that reads back as exactly this, with every setting written out and absolute paths.
std::string toml_of(const ScenarioSpec& spec);

/// Every setting with its value and origin, in the order of toml_of.
std::vector<Setting> settings_of(const ScenarioSpec& spec);

}  // namespace talus::io
