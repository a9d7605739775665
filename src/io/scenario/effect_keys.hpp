#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "scenario_spec.hpp"
#include "table_reader.hpp"

namespace talus::io {

/// Reads [effects] with its tables into spec.values.effects and spec.effects.
void read_effects(ScenarioSpec& spec, TableReader table, const std::filesystem::path& base, const std::string& origin);

/// Adds a fault for each zone of an effect that the input does not describe.
void check_effect_zones(const ScenarioSpec& spec, std::vector<std::string>& faults);

}  // namespace talus::io
