#include "talus/products/energy_lines.hpp"

#include <algorithm>
#include <cmath>

#include "talus/base/expect.hpp"

namespace talus {

void EnergyLines::add(std::span<const StopRow> rows) {
  for (const StopRow& row : rows) {
    if (!rests_on_ground(row.end) || std::isnan(row.energy_line)) continue;
    const long step = std::lround((row.energy_line * 180.0 / kPi + 90.0) * kPerDegree);
    counts_[static_cast<std::size_t>(std::clamp(step, 0L, static_cast<long>(counts_.size()) - 1))] += 1;
    count_ += 1;
  }
}

double EnergyLines::percentile(double share) const {
  TALUS_EXPECT(count_ > 0, "a percentile is of some angles");
  const double rank = std::max(1.0, std::ceil(share * static_cast<double>(count_)));
  double sum = 0.0;
  std::size_t step = 0;
  while (step + 1 < counts_.size() && (sum += static_cast<double>(counts_[step])) < rank) ++step;
  return (static_cast<double>(step) - 90.0 * kPerDegree) / kPerDegree;
}

}  // namespace talus
