#pragma once
#include "talus/simulate/scenario/scenario.hpp"
#include "talus/simulate/tally/tally.hpp"

namespace talus {

/// An empty tally with all that the scenario asks for: thresholds, annual frequencies, energy with rotation.
///
/// @param rounds  most rounds that are summed, as for `AnnualWeights::of`, which may throw
/// @param memory  where the records are stored
Tally tally_of(const Scenario& scenario, std::uint32_t rounds = 1, MemoryPolicy memory = {});

}  // namespace talus
