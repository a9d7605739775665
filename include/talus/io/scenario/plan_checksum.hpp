#pragma once
#include <string>

#include "talus/io/scenario/loaded_scenario.hpp"

namespace talus::io {

/// SHA-256 of all settings of a scenario and of its input files, wherever these lie: equal where the same trajectories
/// follow.
std::string plan_checksum(const LoadedScenario& loaded);

}  // namespace talus::io
