#pragma once
#include <string>

#include "talus/io/scenario/loaded_scenario.hpp"

namespace talus::io {

/// Applies another weighting to a plan: replaces how often blocks fall. The motion of the blocks stays the same.
///
/// The file has [frequency] as a scenario has it (by_true_area, per_area, power_law), and [features]: events per year
/// of a feature of the sources, by its name or number. per_area and power_law replace all frequencies of features and
/// of classes of blocks. Throws InputError with file, line, key, value and what is allowed.
void apply_weighting(const std::string& file, Scenario& scenario);

}  // namespace talus::io
