#include "talus/products/accuracy.hpp"

#include <algorithm>
#include <unordered_map>

#include "talus/products/interval.hpp"

namespace talus {

Accuracy accuracy_of(const Tally& tally, std::uint64_t released, double above) {
  Accuracy worst;
  std::unordered_map<std::uint32_t, double> known;  // many cells have the same count
  const Grid& grid = tally.grid();
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      if (column % kRegionSide == 0) tally.memory().keep_below_limit();
      const CellRecord* cell = tally.find(column, row);
      if (cell == nullptr) continue;
      const double probability = static_cast<double>(cell->passages) / static_cast<double>(released);
      if (!(probability > above)) continue;
      const auto [it, fresh] = known.try_emplace(cell->passages);
      if (fresh) {
        const Interval bounds = probability_bounds(cell->passages, released, kConfidence);
        it->second = 0.5 * (bounds.high - bounds.low) / probability;
      }
      worst.half_width = std::max(worst.half_width, it->second);
      worst.cells += 1;
    }
  return worst;
}

}  // namespace talus
