#include "talus/products/energy_lines.hpp"

#include <algorithm>
#include <cmath>

#include "talus/base/expect.hpp"

namespace talus {

void EnergyLines::add(std::span<const StopRow> rows) {
  for (const StopRow& row : rows) {
    if (!rests_on_ground(row.end) || std::isnan(row.energy_line)) continue;
    const long step = std::lround((row.energy_line * 180.0 / kPi + 90.0) * kPerDegree);
    const auto index = static_cast<std::size_t>(std::clamp(step, 0L, static_cast<long>(counts_[0].size()) - 1));
    const bool is_far = std::hypot(row.x - row.x_release, row.y - row.y_release) > kFar;
    for (std::size_t which = 0; which <= (is_far ? 1U : 0U); ++which) {
      counts_[which][index] += 1;
      count_[which] += 1;
    }
  }
}

double EnergyLines::percentile(double share) const {
  TALUS_EXPECT(count() > 0, "a percentile is of some angles");
  const Counts& counts = counts_[far()];
  const double rank = std::max(1.0, std::ceil(share * static_cast<double>(count())));
  double sum = 0.0;
  std::size_t step = 0;
  while (step + 1 < counts.size() && (sum += static_cast<double>(counts[step])) < rank) ++step;
  return (static_cast<double>(step) - 90.0 * kPerDegree) / kPerDegree;
}

}  // namespace talus
