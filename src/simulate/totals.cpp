#include "talus/simulate/totals.hpp"

namespace talus {

void add(Totals& totals, const Totals& part) {
  if (part.limited_blocks > 0 && (totals.limited_blocks == 0 || part.first_limit < totals.first_limit))
    totals.first_limit = part.first_limit;
  for (std::size_t e = 0; e < kEnds; ++e) totals.ends[e] += part.ends[e];
  totals.released += part.released;
  totals.pieces += part.pieces;
  totals.impacts += part.impacts;
  totals.psi_dropped += part.psi_dropped;
  totals.cells_scored += part.cells_scored;
  totals.length_mm += part.length_mm;
  totals.plan_length_mm += part.plan_length_mm;
  totals.left_blocks += part.left_blocks;
  totals.limited_blocks += part.limited_blocks;
  totals.left_weight += part.left_weight;
  totals.barriers.merge(part.barriers);
  totals.sink_cpu_seconds += part.sink_cpu_seconds;
  totals.cpu_seconds += part.cpu_seconds;
}

}  // namespace talus
