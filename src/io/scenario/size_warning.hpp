#pragma once
#include <string>
#include <vector>

#include "scenario_spec.hpp"

namespace talus::io {

/// Adds a warning if the blocks of a scenario have other sizes than those that the presets of its ground were fitted
/// to, and if presets of the 2D model are in a 3D run. A ground whose theta_scale and En50 are both given beside the
/// preset is the user's own. Also if impacts can gain much energy, and `frequency_warnings`. A complete
/// scenario gives all numbers, and there those with the value of the preset are the preset's.
void warn_of_sizes(const ScenarioSpec& spec, const Scenario& scenario, std::vector<std::string>& warnings);

}  // namespace talus::io
