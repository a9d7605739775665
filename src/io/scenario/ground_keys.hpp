#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "scenario_spec.hpp"
#include "table_reader.hpp"

namespace talus::io {

/// Reads the kinds of ground of a scenario, or of a file that it includes: [ground], [ground.zones.NAME].
class GroundReader {
 public:
  /// @param origin  of what is read, for the record: "scenario", "include fitted.toml"
  GroundReader(ScenarioSpec& spec, std::string origin, std::vector<std::string>& faults)
      : spec_(spec), origin_(std::move(origin)), faults_(faults) {}

  /// `default` and `zones`; a zone that is there already keeps what is not said again, unless a preset is named.
  void read(TableReader& ground);

  /// The same on a profile: each zone has intervals of x [m], no code.
  void read_on_profile(TableReader& ground) {
    on_profile_ = true;
    read(ground);
  }

  /// A fault where zones are described and no file says where they are.
  void check_file(const TableReader& ground, const std::string& include);

 private:
  bool set_preset(TableReader& table, const std::string& key, const std::string& name, ZoneSpec& zone);
  void read_zone(TableReader table, ZoneSpec zone);
  void store(ZoneSpec zone);

  ScenarioSpec& spec_;
  bool on_profile_ = false, flag_ = false;  // flag_: the preset of the default ground is the command line's
  std::string origin_;
  std::vector<std::string>& faults_;
};

}  // namespace talus::io
