#pragma once
#include <span>
#include <string>

#include "talus/simulate/scenario/presets.hpp"
#include "talus/simulate/scenario/scenario.hpp"

namespace talus {

/// How a warning about block sizes, or about a ground that was fitted to no data, begins, in run.json, too.
inline constexpr std::string_view kSizeWarning = "block sizes: ", kGuessWarning = "first guess: ";
/// How the warning about sizes to which the ground was not fitted begins.
inline constexpr std::string_view kOtherSizes = "block sizes: diameters are ";

/// Smallest and largest diameter of the blocks at their release [m]. The scenario must be valid.
Range diameters_of(const Scenario& scenario);

/// One line if blocks of the scenario are smaller or larger than those that a preset of its ground, or of block-mass,
/// was fitted to, or if these sizes are not known: the presets, the sizes, and which way the results are wrong. Empty
/// if there is nothing to say.
std::string size_warning(const Scenario& scenario, std::span<const Preset* const> presets);

/// "0.5 to 1.2 m", for messages.
std::string metres(const Range& range);

/// One line if presets of the ground were fitted to no data. Empty if there is none.
std::string guess_warning(std::span<const Preset* const> presets);

/// Words by which a text of `rare_class_warning` is known.
inline constexpr std::string_view kRareClasses = "few paths stand for all events of a class: ";

/// One line if classes of blocks with a frequency are drawn so seldom that few paths stand for all their events. Empty
/// if there is none.
std::string rare_class_warning(const Scenario& scenario);

/// One line if an effect sorts the sizes the wrong way: rest-in-roughness without block-mass. Empty if none does.
std::string sorting_warning(const Effects& effects);

}  // namespace talus
