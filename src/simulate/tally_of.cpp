#include "talus/simulate/tally_of.hpp"

#include <utility>

#include "talus/simulate/scenario/frequency.hpp"

namespace talus {

Tally tally_of(const Scenario& scenario, std::uint32_t rounds, MemoryPolicy memory) {
  Tally tally(scenario.surface.grid(), scenario.output.energy_thresholds, scenario.output.height_thresholds, memory);
  if (auto weights = AnnualWeights::of(scenario, rounds)) tally.keep_hazard(std::move(*weights));
  if (scenario.output.count_rotation) tally.count_rotation();
  if (scenario.output.energy_total) tally.keep_energy_total();
  return tally;
}

}  // namespace talus
