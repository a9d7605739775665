#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scenario_spec.hpp"
#include "table_reader.hpp"

namespace talus::io {

/// What is wrong with a text that stands for a zone in a raster, by the rule of `code`; nothing if a raster can hold it
/// and `code` reads it back.
std::optional<std::string> fault_of_code(const std::string& text);

/// The preset of the command line in place of the default ground that an included file describes.
void lay_preset_over_include(ScenarioSpec& spec);

/// Adds a fault if zones are described, by the scenario or a model, and neither it nor a flag names the file that says
/// where they are: every number of these zones would be left out unnoticed.
void check_zones_have_file(const ScenarioSpec& spec, std::vector<std::string>& faults);

/// Reads the kinds of ground of a scenario, or of a file that it includes: [ground], [ground.zones.NAME].
class GroundReader {
 public:
  /// @param origin  of what is read, for the record: "scenario", "include fitted.toml"
  GroundReader(ScenarioSpec& spec, std::string origin, std::vector<std::string>& faults)
      : spec_(spec), origin_(std::move(origin)), faults_(faults) {}

  /// Reads `default` and `zones`. A zone that was read before keeps the parameters that are not given again, unless a
  /// preset is given.
  void read(TableReader& ground);

  /// Reads them for a profile: each zone has intervals of x [m], no code.
  void read_on_profile(TableReader& ground) {
    on_profile_ = true;
    read(ground);
  }

 private:
  /// Adds a fault if one table gives the preset of the default ground twice, and not the same.
  static void refuse_two_defaults(TableReader& ground, const TableReader& zones);
  /// Warns of a new zone that is called as a preset, and is not of it.
  void warn_of_name(const std::string& file, const ZoneSpec& zone, const TomlValue& table);
  bool set_preset(TableReader& table, const std::string& key, const std::string& name, ZoneSpec& zone);
  void read_zone(TableReader table, ZoneSpec zone);
  void store(ZoneSpec zone);

  ScenarioSpec& spec_;
  bool on_profile_ = false, flag_ = false;  // flag_: the command line gave the preset of the default ground
  std::string origin_;
  std::vector<std::string>& faults_;
};

}  // namespace talus::io
