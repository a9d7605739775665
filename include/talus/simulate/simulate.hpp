#pragma once
#include "talus/simulate/sinks.hpp"
#include "talus/simulate/tally/tally.hpp"
#include "talus/simulate/totals.hpp"

namespace talus {

/// Traces every trajectory of the scenario and scores it.
///
/// @param threads  0: as many as the machine has
Totals simulate(const Scenario& scenario, Tally& tally, const Sinks& sinks, int threads);

}  // namespace talus
