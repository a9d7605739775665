#pragma once
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "talus/io/loaded.hpp"

namespace talus::io {

/// A file that the input names.
struct NamedFile {
  std::string path;   ///< absolute; empty: none
  std::string where;  ///< "scenario.toml:3: dem = 'dem.tif'" or "flag --dem = 'dem.tif'", for messages
};

/// A kind of ground as the input says it.
struct ZoneSpec {
  std::string name;
  std::string preset;
  Ground ground;
  std::set<std::string> own;  ///< the parameters that are not the preset's
};

/// An effect that the input names: where it acts. Its numbers are in `values`.
struct EffectSpec {
  std::string where;               ///< "scenario.toml:12: [effects.vegetation-drag]", for messages
  std::vector<std::string> zones;  ///< empty: in all
  std::string zones_where;
  NamedFile file;
};

/// All that a scenario file and the flags say, before any other file is opened.
struct ScenarioSpec {
  NamedFile scenario, dem, sources, ground, screens;
  std::string ground_field;
  ZoneSpec default_ground;
  std::vector<ZoneSpec> zones;                ///< in the order of the file
  std::map<std::string, EffectSpec> effects;  ///< by name
  Range release_height = SourceFeature{}.release_height;
  Scenario values;                             ///< its settings; without terrain, sources and screens
  std::map<std::string, std::string> origins;  ///< of the keys that are given: "scenario", "flag --seed"

  std::string origin(const std::string& key) const {
    const auto found = origins.find(key);
    return found == origins.end() ? "default" : found->second;
  }
};

/// Reads the scenario file, where there is one, and lays the flags over it. Faults of single settings are collected;
/// what makes reading on senseless (no such file, no TOML) is thrown as InputError.
ScenarioSpec read_spec(const RunFlags& flags, std::vector<std::string>& faults);

/// A path as it is given in the folder `base`; what is no file for the system (PG:..., WFS:...) is left to GDAL.
std::string absolute_path(const std::string& given, const std::filesystem::path& base);

/// The default ground: the flag's preset, else the default one.
void start_with_preset(ScenarioSpec& spec, const RunFlags& flags, std::vector<std::string>& faults);
/// Lays the other flags over what the scenario file says.
void lay_flags(ScenarioSpec& spec, const RunFlags& flags, std::vector<std::string>& faults);

/// A scenario file that gives exactly this again, with every setting written out and absolute paths.
std::string toml_of(const ScenarioSpec& spec);

/// Every setting with its value and origin, in the order of toml_of.
std::vector<Setting> settings_of(const ScenarioSpec& spec);

}  // namespace talus::io
