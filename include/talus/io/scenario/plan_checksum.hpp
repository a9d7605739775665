#pragma once
#include <cstdint>
#include <string>

#include "talus/io/scenario/loaded_scenario.hpp"

namespace talus::io {

/// SHA-256 of all settings of a scenario and of its input files, in whatever folder they are. Plans with equal
/// checksums have the same trajectories.
///
/// @param rounds  that the trajectories of `loaded` are (`set_rounds`): the checksum is that of one of them
std::string plan_checksum(const LoadedScenario& loaded, std::uint32_t rounds = 1);

}  // namespace talus::io
