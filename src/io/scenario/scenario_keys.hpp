#pragma once
#include <string>
#include <vector>

#include "scenario_spec.hpp"
#include "table_reader.hpp"

namespace talus::io {

/// Reads the scenario file, if one is given, and overrides it with the flags. Faults of single settings are collected.
/// A fault that ends the reading (no such file, no TOML) is thrown as InputError.
ScenarioSpec read_spec(const RunFlags& flags, std::vector<std::string>& faults);

/// Reads the keys that a scenario and a profile share: seed, trajectories, day, [blocks], [model], [effects].
void read_common_keys(ScenarioSpec& spec, TableReader& top, std::vector<std::string>& faults);

/// Reads what a scenario may include, and a model for a campaign: [ground] default, [ground.zones.*], the impact law in
/// [model], [effects.*], `line` of [barriers], [[instrument_bias]]. Any other key is a fault.
///
/// @param name    of the file in messages
/// @param origin  for the record: "include fitted.toml"
void read_model_keys(ScenarioSpec& spec, const std::string& path, const std::string& name, const std::string& origin,
                     std::vector<std::string>& faults);

/// Puts faults in the order of the lines of the file that they are in; those without a line first.
void sort_by_line(std::vector<std::string>& faults, const std::string& file);

}  // namespace talus::io
