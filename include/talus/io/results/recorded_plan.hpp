#pragma once
#include <filesystem>
#include <string>

#include "talus/io/scenario/loaded_scenario.hpp"

namespace talus::io {

/// The plan of a finished run, read again from the scenario.toml in its folder.
///
/// @param plan  `plan_checksum` of the run
/// Throws InputError if the scenario, or a file that it names, has changed since the run.
LoadedScenario recorded_plan(const std::filesystem::path& folder, const std::string& plan);

/// A scenario of any origin. If it is the scenario.toml of a run or of a part, whose record (run.json, part.json) lies
/// beside it, throws InputError as `recorded_plan` does.
LoadedScenario recorded_or_own_plan(const std::string& scenario);

}  // namespace talus::io
