#include "talus/simulate/simulate.hpp"

#include "talus/simulate/simulation.hpp"

namespace talus {

Totals simulate(const Scenario& scenario, Tally& tally, const Sinks& sinks, int threads, int lanes) {
  Simulation simulation(scenario, {}, false, tally, sinks);
  do simulation.advance(threads, lanes);
  while (!simulation.round_done() && !simulation.totals().interrupted);
  return simulation.totals();
}

}  // namespace talus
