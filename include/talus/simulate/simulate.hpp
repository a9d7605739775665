#pragma once
#include "talus/simulate/sinks.hpp"
#include "talus/simulate/tally/tally.hpp"
#include "talus/simulate/totals.hpp"

namespace talus {

/// Traces every trajectory of the scenario and scores it.
///
/// @param threads  0: as many as the machine has
/// @param lanes    trajectories in one instruction, as for Tracer; 0: as many as the processor has
Totals simulate(const Scenario& scenario, Tally& tally, const Sinks& sinks, int threads, int lanes = 0);

}  // namespace talus
