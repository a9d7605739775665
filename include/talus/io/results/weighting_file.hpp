#pragma once
#include <string>

#include "talus/io/scenario/loaded_scenario.hpp"

namespace talus::io {

/// Another weighting of a plan: replaces how often blocks fall, and nothing that moves a block.
///
/// The file has [frequency] as a scenario has it (by_true_area, per_area, power_law), and [features]: events per year
/// of a feature of the sources, by its name or number. per_area and power_law take the place of all frequencies that
/// features and classes of blocks have. Throws InputError with file, line, key, value and what is allowed.
void apply_weighting(const std::string& file, Scenario& scenario);

}  // namespace talus::io
