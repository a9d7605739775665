#pragma once
#include <string>

#include "talus/io/scenario/loaded_scenario.hpp"

namespace talus::io {

/// SHA-256 of all settings of a scenario and of its input files, in whatever folder they are. Plans with equal
/// checksums have the same trajectories.
std::string plan_checksum(const LoadedScenario& loaded);

}  // namespace talus::io
