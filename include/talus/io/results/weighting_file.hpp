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
  std::vector<double> class_shares;  ///< of the events, kept by the classes of blocks; empty if none have frequencies
  std::vector<std::string> warnings{};  ///< `frequency_warnings` of the plan that has these frequencies
};

/// Applies another weighting to a plan: replaces how often blocks fall. The motion of the blocks stays the same.
///
/// The file has [frequency] as a scenario has it (by_true_area, total, per_area, power_law), or [features]: events per
/// year of a feature of the sources, by its name or number, or as "FID 3", which is always the number; it must have
/// released blocks. total, per_area and power_law replace all frequencies.
/// Features that are not listed keep theirs; all must be listed if the frequencies of the run are not by feature.
/// Classes of blocks that have frequencies keep their shares of the events, but for power_law. docs/hazard.md, "Another
/// weighting". Throws InputError with file, line, key, value and what is allowed, and if no blocks fall with them.
/// @return what the file says, the shares and the warnings
GivenFrequencies apply_weighting(const std::string& file, Scenario& scenario);

/// "the classes of blocks keep their shares of the events: 77, 19, 3.8 %"; empty if they keep none.
std::string class_shares_text(const GivenFrequencies& given);

}  // namespace talus::io
