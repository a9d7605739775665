#pragma once
#include <span>
#include <string>

#include "talus/simulate/scenario/presets.hpp"
#include "talus/simulate/scenario/scenario.hpp"

namespace talus {

/// How a warning about block sizes begins, in run.json, too.
inline constexpr std::string_view kSizeWarning = "block sizes: ";

/// Smallest and largest diameter of the blocks at their release [m]. The scenario must be valid.
Range diameters_of(const Scenario& scenario);

/// One line if blocks of the scenario are smaller or larger than those that a preset of its ground was fitted to, or if
/// these sizes are not known: the presets, the sizes, and what to expect. Empty if there is nothing to say.
std::string size_warning(const Scenario& scenario, std::span<const Preset* const> presets);

}  // namespace talus
