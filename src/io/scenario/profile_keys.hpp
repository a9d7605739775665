#pragma once
#include <string>
#include <vector>

#include "scenario_spec.hpp"
#include "talus/simulate/scenario/parameter_table.hpp"

namespace talus::io {

/// The spacing of the columns of a profile.
inline constexpr Bounds kProfileStep{"step", "m", "spacing of the columns", 0.05, 10.0};

/// Reads the file of a profile as `read_spec` reads a scenario; `profile` of the result is set.
ScenarioSpec read_profile_spec(const RunFlags& flags, std::vector<std::string>& faults);

}  // namespace talus::io
