#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "talus/io/scenario/loaded_scenario.hpp"

namespace talus::io {

/// The frequencies in a file of another weighting, as hazard.json and barrier_ID.json record them.
struct GivenFrequencies {
  std::string file, sha256;  ///< file: empty if none was given
  FrequencyRules rules;      ///< total, per_area and law of [frequency]; `kNotGiven` where it does not say
  std::optional<bool> by_true_area;
  std::vector<std::pair<std::string, double>> features;  ///< as the file calls them [1/year]
};

/// Applies another weighting to a plan: replaces how often blocks fall. The motion of the blocks stays the same.
///
/// The file has [frequency] as a scenario has it (by_true_area, per_area, power_law), and [features]: events per year
/// of a feature of the sources, by its name or number. per_area and power_law replace all frequencies of features and
/// of classes of blocks. Throws InputError with file, line, key, value and what is allowed.
/// @return what the file says
GivenFrequencies apply_weighting(const std::string& file, Scenario& scenario);

}  // namespace talus::io
