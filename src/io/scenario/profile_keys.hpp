#pragma once
#include <string>
#include <vector>

#include "scenario_spec.hpp"

namespace talus::io {

/// Reads the file of a profile as `read_spec` reads a scenario; `profile` of the result is set.
ScenarioSpec read_profile_spec(const RunFlags& flags, std::vector<std::string>& faults);

}  // namespace talus::io
