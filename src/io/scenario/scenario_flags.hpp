#pragma once
#include <string>
#include <vector>

#include "scenario_spec.hpp"

namespace talus::io {

/// Rule of `[output] vectors` and `--vectors`.
inline constexpr const char* kVectorsRule = "must be 'gpkg' (GeoPackage) or 'fgb' (FlatGeobuf)";

/// Sets the default ground to the preset of the flag, else to `standard`.
void start_with_preset(ScenarioSpec& spec, const RunFlags& flags, std::string_view standard,
                       std::vector<std::string>& faults);

/// Warns of a preset of the command line under numbers of the file that hide it: easily overlooked.
void warn_of_unused_preset(const ScenarioSpec& spec, std::vector<std::string>& warnings);

/// Reads the model of --parameters over the default ground. A scenario names its model itself, by `include`.
void start_with_model(ScenarioSpec& spec, const RunFlags& flags, std::vector<std::string>& faults);

/// Overrides the scenario file with the other flags.
void lay_flags(ScenarioSpec& spec, const RunFlags& flags, std::vector<std::string>& faults);

}  // namespace talus::io
